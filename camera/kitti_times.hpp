#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace flogmap {

/// When the pictures of a KITTI sequence were taken, one a line; nanoseconds. Seconds since the start, as in
/// the odometry sequences' times.txt, or days and times of day (taken as UTC), as in the raw drives'
/// timestamps.txt: "2011-09-26 13:02:25.594360375". Empty if there is no such file. Throws std::runtime_error
/// naming a line that is neither.
[[nodiscard]] std::vector<std::int64_t> read_kitti_times(const std::filesystem::path& file);

/// The line, from 0, that belongs to each picture: its number where the sequence is whole or begins with
/// number 0, even with missing pictures; else its place in the order, as in parts that were cut out.
/// `pictures` in order.
[[nodiscard]] std::vector<std::size_t> kitti_lines(const std::vector<std::filesystem::path>& pictures,
                                                   std::size_t num_lines);

}  // namespace flogmap
