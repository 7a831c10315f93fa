#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "camera/stereo_frame.hpp"

namespace flogmap {

/// What pages see of a calibration that is being made, and how they steer it. All calls return at once and
/// may come from any thread.
class CalibrationDesk {
 public:
  virtual ~CalibrationDesk() = default;
  /// How it stands, as docs/calibration.md describes it.
  [[nodiscard]] virtual std::string state_json() const = 0;
  /// The newest pair, as taken, grey; null before the first.
  [[nodiscard]] virtual std::shared_ptr<const RectifiedFrame> pictures() const = 0;
  /// Calibrates from the pairs kept so far; false if there are too few.
  virtual bool solve() = 0;
  /// Forgets every pair.
  virtual void restart() = 0;
};

}  // namespace flogmap
