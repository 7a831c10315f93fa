#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>

#include "camera/board_calibration/sitting.hpp"
#include "camera/board_calibration/verdict.hpp"
#include "camera/stereo_source.hpp"
#include "server/calibration_desk.hpp"

namespace flogmap {

struct DeskOptions {
  BoardSpec board;
  Distortion model = Distortion::radtan;
  bool photos = false;  // the source delivers single photos, not a video
  std::string out;      // the file that a calibration is written to
};

/// Looks at the pairs of a source, keeps the good ones and calibrates when it is told to. run() is the only
/// thread that works; everybody else sees the last state it has shown.
class LiveDesk final : public CalibrationDesk {
 public:
  /// Throws std::runtime_error if the board cannot be.
  explicit LiveDesk(const DeskOptions& options);

  /// Looks until the source ends. Without viewers it then calibrates at once; with them it waits for what
  /// they want, until stop().
  void run(StereoSource& source, bool viewers);
  void stop();

  [[nodiscard]] std::string state_json() const override;
  [[nodiscard]] std::shared_ptr<const RectifiedFrame> pictures() const override;
  bool solve() override;
  void restart() override;

  /// The last calibration that was written, if any; why there is none is in problem().
  [[nodiscard]] std::optional<CalibrationVerdict> verdict() const;
  [[nodiscard]] std::string problem() const;

 private:
  enum class Phase : std::uint8_t { looking, calibrating, ended };
  enum class Wish : std::uint8_t { none, solve, restart };

  /// What is shown; the one thing that threads share.
  struct Shown {
    Phase phase = Phase::looking;
    SittingState sitting;
    std::shared_ptr<const RectifiedFrame> pictures;
    double progress = 0;
    std::optional<CalibrationVerdict> verdict;
    std::string problem;
  };

  void look_at(const StereoFrame& frame);
  void fulfil(Wish wish);
  void calibrate();
  Wish take_wish();
  template <typename Change>
  void show(Change change);

  const DeskOptions options_;
  CalibrationSitting sitting_;  // of run()
  mutable std::mutex mutex_;
  std::condition_variable wished_;
  Shown shown_;
  Wish wish_ = Wish::none;
  bool stopped_ = false;
};

}  // namespace flogmap
