#include "server/commands/live_desk.hpp"

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "camera/calibration/opencv_calibration.hpp"
#include "camera/grey.hpp"

namespace flogmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kFewestPairs = 3;

Json pixels_json(const BoardView& view) {
  Json pixels = Json::array();
  for (const Eigen::Vector2d& pixel : view.pixels) pixels.push_back({pixel.x(), pixel.y()});
  return pixels;
}

Json verdict_json(const std::optional<CalibrationVerdict>& verdict) {
  if (!verdict) return nullptr;
  return {{"grade", grade_name(verdict->grade)},
          {"rms_px", verdict->rms_px},
          {"epipolar_p95_px", verdict->epipolar_p95_px},
          {"baseline_m", verdict->baseline_m},
          {"baseline_sigma_m", verdict->baseline_sigma_m},
          {"field_of_view_rad", verdict->field_of_view_rad},
          {"pairs", verdict->num_pairs},
          {"advice", verdict->advice}};
}

}  // namespace

LiveDesk::LiveDesk(const DeskOptions& options) : options_(options), sitting_(options.board, options.photos) {}

template <typename Change>
void LiveDesk::show(Change change) {
  const std::scoped_lock lock(mutex_);
  change(shown_);
}

void LiveDesk::run(StereoSource& source, bool viewers) {
  while (const auto frame = source.next()) {
    look_at(*frame);
    fulfil(take_wish());
  }
  show([](Shown& shown) { shown.phase = Phase::ended; });
  if (!viewers) return fulfil(Wish::solve);
  for (;;) {
    std::unique_lock lock(mutex_);
    wished_.wait(lock, [this] { return stopped_ || wish_ != Wish::none; });
    if (stopped_) return;
    lock.unlock();
    fulfil(take_wish());
  }
}

void LiveDesk::stop() {
  const std::scoped_lock lock(mutex_);
  stopped_ = true;
  wished_.notify_all();
}

LiveDesk::Wish LiveDesk::take_wish() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(wish_, Wish::none);
}

void LiveDesk::look_at(const StereoFrame& frame) {
  // Raw pictures in the type of rectified ones: nothing but the encoder of pictures gets them.
  auto pictures = std::make_shared<const RectifiedFrame>(
      RectifiedFrame{frame.timestamp_ns, to_grey(frame.left), to_grey(frame.right)});
  sitting_.look_at(pictures->left, pictures->right);
  show([&](Shown& shown) {
    shown.sitting = sitting_.state();
    shown.pictures = std::move(pictures);
  });
}

void LiveDesk::fulfil(Wish wish) {
  if (wish == Wish::solve) calibrate();
  if (wish != Wish::restart) return;
  sitting_.restart();
  show([this](Shown& shown) {
    shown.sitting = sitting_.state();
    shown.verdict.reset();
    shown.problem.clear();
  });
}

void LiveDesk::calibrate() {
  Phase before{};
  show([&](Shown& shown) { before = std::exchange(shown.phase, Phase::calibrating), shown.progress = 0; });
  std::optional<CalibrationVerdict> verdict;
  std::string problem;
  try {
    const CalibratorOptions how{
        .model = options_.model,
        .width_px = sitting_.state().width_px,
        .height_px = sitting_.state().height_px,
        .on_progress = [this](double share) { show([&](Shown& shown) { shown.progress = share; }); }};
    const CalibrationResult result = calibrate_stereo(board_points(options_.board), sitting_.pairs(), how);
    verdict = judge(result, sitting_.names());
    std::ofstream out(options_.out, std::ios::binary | std::ios::trunc);
    out << format_opencv(result.calibration) << std::flush;
    if (!out) problem = options_.out + ": cannot be written";
  } catch (const std::exception& error) {
    problem = error.what();
  }
  show([&](Shown& shown) {
    shown.phase = before;
    shown.verdict = problem.empty() ? std::move(verdict) : std::nullopt;
    shown.problem = problem;
  });
}

std::string LiveDesk::state_json() const {
  const std::scoped_lock lock(mutex_);
  static constexpr std::array<const char*, 3> kPhases{"looking", "calibrating", "ended"};
  const SittingState& sitting = shown_.sitting;
  const Json json = {{"phase", kPhases.at(static_cast<std::size_t>(shown_.phase))},
                     {"frame", sitting.num_frames},
                     {"width_px", sitting.width_px},
                     {"height_px", sitting.height_px},
                     {"left", {{"corners", pixels_json(sitting.left)}, {"areas", sitting.left_areas}}},
                     {"right", {{"corners", pixels_json(sitting.right)}, {"areas", sitting.right_areas}}},
                     {"kept", sitting.kept},
                     {"pairs", sitting.num_pairs},
                     {"pairs_wanted", CalibrationSitting::kEnoughPairs},
                     {"tilted", sitting.tilted},
                     {"advice", sitting.advice},
                     {"enough", sitting.enough},
                     {"progress", shown_.progress},
                     {"verdict", verdict_json(shown_.verdict)},
                     {"problem", shown_.problem},
                     {"file", options_.out}};
  return json.dump();
}

std::shared_ptr<const RectifiedFrame> LiveDesk::pictures() const {
  const std::scoped_lock lock(mutex_);
  return shown_.pictures;
}

bool LiveDesk::solve() {
  const std::scoped_lock lock(mutex_);
  if (shown_.sitting.num_pairs < kFewestPairs) return false;
  wish_ = Wish::solve;
  wished_.notify_all();
  return true;
}

void LiveDesk::restart() {
  const std::scoped_lock lock(mutex_);
  wish_ = Wish::restart;
  wished_.notify_all();
}

std::optional<CalibrationVerdict> LiveDesk::verdict() const {
  const std::scoped_lock lock(mutex_);
  return shown_.verdict;
}

std::string LiveDesk::problem() const {
  const std::scoped_lock lock(mutex_);
  return shown_.problem;
}

}  // namespace flogmap
