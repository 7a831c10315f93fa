#include "mapping/loop/place_index.hpp"

#include <algorithm>
#include <bit>
#include <random>

namespace flogmap {
namespace {

constexpr int kNumBits = 256;
constexpr int kMostDifferingBits = 56;  // of two patches of the same point
constexpr std::uint32_t kSeed = 20260101;

struct SamplePair {
  std::uint8_t a, b;
};

/// std::mt19937's numbers are the same everywhere, those of the distributions are not.
std::array<SamplePair, kNumBits> make_pairs() {
  std::mt19937 random(kSeed);
  std::array<SamplePair, kNumBits> pairs{};
  for (SamplePair& pair : pairs) {
    do {
      pair = {static_cast<std::uint8_t>(random() % 64), static_cast<std::uint8_t>(random() % 64)};
    } while (pair.a == pair.b);
  }
  return pairs;
}

}  // namespace

BinaryPatch binary_patch(const Descriptor& descriptor) {
  static const auto pairs = make_pairs();
  BinaryPatch patch{};
  for (int i = 0; i < kNumBits; ++i) {
    const bool brighter = descriptor[pairs[i].a] > descriptor[pairs[i].b];
    patch[i / 64] |= std::uint64_t{brighter} << (i % 64);
  }
  return patch;
}

int differing_bits(const BinaryPatch& a, const BinaryPatch& b) {
  int count = 0;
  for (std::size_t w = 0; w < a.size(); ++w) count += std::popcount(a[w] ^ b[w]);
  return count;
}

PlaceIndex::PlaceIndex() {
  std::mt19937 random(kSeed + 1);
  for (auto& bits : key_bits_) {
    for (std::uint8_t& bit : bits) bit = static_cast<std::uint8_t>(random() % kNumBits);
  }
}

std::uint32_t PlaceIndex::key(int table, const BinaryPatch& patch) const {
  std::uint32_t key = 0;
  for (const std::uint8_t bit : key_bits_[table]) {
    key = (key << 1) | static_cast<std::uint32_t>((patch[bit / 64] >> (bit % 64)) & 1U);
  }
  return key;
}

void PlaceIndex::add(const std::vector<BinaryPatch>& patches) {
  views_.push_back(patches);
  enter(num_views() - 1);
}

void PlaceIndex::enter(int view) {
  const std::vector<BinaryPatch>& patches = views_[view];
  for (std::size_t i = 0; i < patches.size(); ++i) {
    for (int t = 0; t < kNumTables; ++t) {
      tables_[t][key(t, patches[i])].push_back({view, static_cast<std::int32_t>(i)});
    }
  }
}

void PlaceIndex::forget_oldest(int count) {
  views_.erase(views_.begin(), views_.begin() + std::min(count, num_views()));
  tables_ = {};
  for (int view = 0; view < num_views(); ++view) enter(view);
}

/// One vote of this patch for every view that has one like it.
void PlaceIndex::vote(const BinaryPatch& patch, int num_views, std::vector<int>& last_voter, int voter,
                      std::vector<int>& votes) const {
  for (int t = 0; t < kNumTables; ++t) {
    const auto bucket = tables_[t].find(key(t, patch));
    if (bucket == tables_[t].end()) continue;
    for (const Entry& entry : bucket->second) {
      if (entry.view >= num_views || last_voter[entry.view] == voter) continue;
      if (differing_bits(patch, views_[entry.view][entry.patch]) > kMostDifferingBits) continue;
      last_voter[entry.view] = voter;
      ++votes[entry.view];
    }
  }
}

std::vector<PlaceCandidate> PlaceIndex::query(const std::vector<BinaryPatch>& patches, int num_views,
                                              int max_candidates) const {
  std::vector<int> votes(views_.size(), 0), last_voter(views_.size(), -1);
  for (std::size_t i = 0; i < patches.size(); ++i)
    vote(patches[i], num_views, last_voter, static_cast<int>(i), votes);
  std::vector<PlaceCandidate> candidates;
  for (int view = 0; view < std::min(num_views, this->num_views()); ++view) {
    if (votes[view] > 0) candidates.push_back({view, votes[view]});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const PlaceCandidate& a, const PlaceCandidate& b) { return a.votes > b.votes; });
  if (static_cast<int>(candidates.size()) > max_candidates) candidates.resize(max_candidates);
  return candidates;
}

}  // namespace flogmap
