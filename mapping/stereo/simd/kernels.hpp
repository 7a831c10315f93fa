// The inner loops of both matchers, one row at a time, on bytes. Compiled once per instruction set; all give
// the same bits. A "volume row" is `width` pixels of `stride` bytes: one byte per disparity, lanes beyond the
// last disparity are padding.
#pragma once

#include <cstdint>

namespace flogmap {

inline constexpr int kCensusPlanes = 3;   // 24 comparisons per pixel, a byte per plane
inline constexpr int kCensusReachPx = 2;  // 5 x 5 window
inline constexpr int kMaxLanes = 64;      // rows that are read in whole registers need this much slack
inline constexpr int kMaxVolumeLanes = 256;

/// Pointers to the same row of the three planes.
struct CensusRow {
  const std::uint8_t* plane[kCensusPlanes];
};

/// What one row's winner takes all says. `right` is reversed: entry W-1-x + d belongs to right pixel x - d.
struct WinnersRow {
  std::uint8_t* best;    // index of the cheapest disparity, the smallest of equals
  std::uint8_t* cost;    // its cost
  std::uint8_t* before;  // cost one disparity less; undefined at index 0
  std::uint8_t* after;   // cost one disparity more; undefined at the last index
  std::uint8_t* second;  // least cost more than one disparity away; null if nobody asks
  std::uint8_t* right;   // best index seen from the right pixel; width + stride entries
};

/// Costs of changing the disparity from one pixel of a path to the next: P1 by one, P2 by more.
struct PathPenalties {
  std::uint8_t small_step;    // P1
  const std::uint8_t* jumps;  // P2 per pixel; see the kernels for which neighbour
};

/// Path costs of one row and their minima per pixel; continued by the next row.
struct PathRow {
  std::uint8_t* costs;   // volume row
  std::uint8_t* minima;  // per pixel
};

struct MatchKernels {
  const char* name;
  int stride;  // bytes per pixel of a volume for this number of disparities

  /// `rows`: five padded rows around the pixel, each readable from -2 to width + 2 + kMaxLanes.
  /// Planes take width + kMaxLanes entries.
  void (*census_row)(const std::uint8_t* const* rows, int width, std::uint8_t* const* planes);

  /// Volume row: sum over x-1, x, x+1 (clamped) of the Hamming distances; at most 72.
  /// `right` is reversed: entry W-1-x + d belongs to left pixel x and disparity index d.
  void (*hamming_row)(const CensusRow& left, const CensusRow& right, int width, std::uint8_t* sums);

  /// Cost of a 3 x 3 window from three volume rows: (a + b + c + 4) / 8; at most 27.
  void (*window_cost)(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c, int num_bytes,
                      std::uint8_t* cost);

  /// Volume row: the sum over x-step, x, x+step (clamped).
  void (*sum_along)(const std::uint8_t* costs, int width, int step, std::uint8_t* sums);

  /// Cost of a large window from three rows of sum_along: (a + b + c + 1) / 2; at most 122.
  void (*box_cost)(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c, int num_bytes,
                   std::uint8_t* cost);

  /// Sum of the two least of the four windows at (x - reach, x + reach) in two rows (clamped); at most 244.
  void (*two_best_corners)(const std::uint8_t* above, const std::uint8_t* below, int width, int reach,
                           std::uint8_t* sums);

  /// Semi-global path costs from the row before into this one. `jumps[x]`: between the two rows.
  /// `padding`: stride bytes, 0xFF in padding lanes, else 0. `here` may be `before`.
  void (*path_down)(const std::uint8_t* costs, int width, const std::uint8_t* padding,
                    const PathPenalties& penalties, const PathRow& before, const PathRow& here);

  /// Semi-global path costs along the row, to the right and to the left, summed. `jumps[x]`: between
  /// pixels x-1 and x; width + 1 entries.
  void (*paths_along)(const std::uint8_t* costs, int width, const std::uint8_t* padding,
                      const PathPenalties& penalties, std::uint8_t* sums);

  /// Winners of the mean of `along` and `down + up`.
  void (*winners_row)(const std::uint8_t* along, const std::uint8_t* down, const std::uint8_t* up, int width,
                      const std::uint8_t* padding, const WinnersRow& winners);
};

/// The kernels to use on this processor, for 1 <= num_disparities <= 256: those that pad the volumes least,
/// for memory is what limits them, and of these the widest.
MatchKernels match_kernels(int num_disparities);

/// All kernels that this processor runs, plain C++ first: for tests.
using KernelMaker = MatchKernels (*)(int num_disparities);
struct KernelMakers {
  KernelMaker maker[5];
  int count;
};
KernelMakers available_kernels();

}  // namespace flogmap
