// Which earlier views may show this place? Binary patches in hash tables.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "mapping/odometry/features.hpp"

namespace flogmap {

/// 256 comparisons of brightness within a patch (after BRIEF, Calonder et al. 2010).
using BinaryPatch = std::array<std::uint64_t, 4>;

/// Which samples are compared is fixed for ever: the same picture gives the same bits.
[[nodiscard]] BinaryPatch binary_patch(const Descriptor& descriptor);

/// In how many comparisons two patches differ, 0 to 256.
[[nodiscard]] int differing_bits(const BinaryPatch& a, const BinaryPatch& b);

/// An earlier view, and how many of the asked patches it seems to show.
struct PlaceCandidate {
  int view = 0;
  int votes = 0;
};

/// Remembers the patches of views. Every patch stands in several hash tables, by some of its bits each, so
/// that a question meets only the few patches that are likely to be alike.
class PlaceIndex {
 public:
  PlaceIndex();

  /// Views are numbered 0, 1, 2 ... as they are added.
  void add(const std::vector<BinaryPatch>& patches);

  /// Forgets the first `count` views; the others are numbered from 0 again.
  void forget_oldest(int count);

  /// The `max_candidates` views with most votes among the first `num_views`, most votes first; ties: the
  /// older.
  [[nodiscard]] std::vector<PlaceCandidate> query(const std::vector<BinaryPatch>& patches, int num_views,
                                                  int max_candidates) const;

  [[nodiscard]] int num_views() const { return static_cast<int>(views_.size()); }

 private:
  static constexpr int kNumTables = 8;
  static constexpr int kKeyBits = 12;

  struct Entry {
    std::int32_t view = 0;
    std::int32_t patch = 0;
  };
  using Table = std::unordered_map<std::uint32_t, std::vector<Entry>>;

  void enter(int view);
  [[nodiscard]] std::uint32_t key(int table, const BinaryPatch& patch) const;
  void vote(const BinaryPatch& patch, int num_views, std::vector<int>& last_voter, int voter,
            std::vector<int>& votes) const;

  std::array<std::array<std::uint8_t, kKeyBits>, kNumTables> key_bits_;
  std::array<Table, kNumTables> tables_;
  std::vector<std::vector<BinaryPatch>> views_;
};

}  // namespace flogmap
