#include "server/pipeline.hpp"

#include <utility>

#include "mapping/stereo/row_offset.hpp"

namespace flogmap {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kFrameQueue = 2;
constexpr std::chrono::milliseconds kStatusEvery{500};
constexpr const char* kPlaceUnknown =
    "not found again after a loss: show a mapped place (needs loop closure)";

}  // namespace

Pipeline::Pipeline(const PipelineOptions& options, std::unique_ptr<StereoSource> source, FrontEnd front_end,
                   MapIntegrator integrator, PipelineObserver& observer)
    : options_(options),
      source_(std::move(source)),
      front_end_(std::move(front_end)),
      observer_(observer),
      assumed_(source_->info().assumed),
      control_(source_->info(), options.rate, options.loop),
      statistics_(options.statistics_window),
      frames_(kFrameQueue, source_->info().live ? WhenFull::drop_oldest : WhenFull::wait),
      map_({std::move(integrator),
            {.keep_views = options.loop_closure.has_value() || options.keep_views,
             .max_view_bytes = options.max_view_bytes}},
           observer, statistics_, options.end_with_source,
           [this] { return control_.state() == SessionState::draining; }) {
  control_.begin_level(options.continued.level, [this] { return map_.why_not_levelled(); });
  if (options.loop_closure) loops_.emplace(*options.loop_closure, front_end_.camera(), source_->info().live);
}

void Pipeline::start() {
  threads_.emplace_back([this] { run_stage([this] { capture(); }); });
  threads_.emplace_back([this] { run_stage([this] { see(); }); });
  threads_.emplace_back([this] { run_stage([this] { map_.run(); }); });
  if (loops_) threads_.emplace_back([this] { run_stage([this] { loops_->run(); }); });
}

void Pipeline::stop() {
  control_.drain();
  source_->stop();
}

void Pipeline::wait() {
  threads_.clear();  // joins
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

/// Runs one stage's loop. If it throws, everything before and behind it ends too.
template <typename Stage>
void Pipeline::run_stage(Stage stage) {
  try {
    stage();
  } catch (const std::exception& error) {
    control_.failed(error.what());
    {
      const std::scoped_lock lock(counters_mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
    stop();
    frames_.close();
    map_.abandon();  // nobody waits for a promise that cannot be kept
    if (loops_) loops_->close();
  }
}

// ---- vision thread
void Pipeline::see() {
  while (std::optional<Captured> captured = frames_.pop()) {
    if (captured->generation.number != seen_generation_) begin_generation(captured->generation);
    if (captured->ended) finish(captured->generation);
    if (captured->tell) report_status();
    if (captured->level) level_map(*captured->level);
    if (!captured->frame) continue;
    correct_path();
    FrontEndResult result = front_end_.process(*captured->frame);
    report(*captured, result);
    pass_on(result);
    if (Clock::now() - status_at_ > kStatusEvery) report_status();
  }
  wait_for_loops();
  report_status();
  if (loops_) loops_->close();
  map_.close();
}

/// Nothing may follow: whoever reads that the session has finished finds all of its map and the last counts.
void Pipeline::finish(const Generation& generation) {
  FrontEndResult rest = front_end_.finish();
  pass_on(rest);
  wait_for_loops();
  map_.wait_for_rest();
  report_status();
  control_.finished(generation.number);
}

/// Poses to the observer, views to the map and to where loops are found.
void Pipeline::pass_on(FrontEndResult& result) {
  const std::vector<TrajectoryEntry> placed = path_.add(result.path);
  unplaced_frames_ = path_.num_unplaced();
  {
    const std::scoped_lock lock(counters_mutex_);
    counters_.mapped_views += result.views.size();
  }
  if (!placed.empty()) observer_.path_grew(placed);
  for (View& view : result.views) {
    if (loops_) loops_->offer(view);
    map_.integrate(std::move(view));
  }
}

void Pipeline::wait_for_loops() {
  if (loops_) loops_->wait_for_rest();
  correct_path();
}

/// What closed loops say of the path. Odometry is never told.
void Pipeline::correct_path() {
  std::optional<PathCorrection> correction = loops_ ? loops_->take() : std::nullopt;
  if (!correction) return;
  correction_ = correction->levelled(correction_.level());
  rewrite_path("loop closed");
}

/// Odometry and loops go on in the world of the automatic start.
void Pipeline::level_map(const HandLevel& level) {
  correction_ = correction_.levelled(level);
  rewrite_path("levelled by hand");
  report_status();
}

void Pipeline::rewrite_path(const std::string& reason) {
  path_.correct(correction_);
  unplaced_frames_ = path_.num_unplaced();
  observer_.path_rewritten({++num_corrections_, path_.corrected(), correction_.level(), reason});
  map_.correct(correction_, num_corrections_);
}

/// The first generation goes on with the continued map, if there is one.
void Pipeline::begin_generation(const Generation& generation) {
  MapBegin begin;
  begin.epoch = generation.epoch;
  begin.camera = front_end_.camera();
  begin.reason = generation.reason;
  if (seen_generation_ == 0) {
    begin.tiles = options_.continued.tiles;
    begin.trajectory = options_.continued.trajectory;
    begin.views = options_.continued.views;
  } else {
    front_end_.reset();
  }
  seen_generation_ = generation.number;
  {
    const std::scoped_lock lock(counters_mutex_);
    counters_.tracked -= unplaced_frames_;  // their place was never found
    counters_.lost += unplaced_frames_.exchange(0);
  }
  path_ = CorrectedPath(begin.trajectory);
  correction_ = PathCorrection().levelled(generation.level);
  path_.correct(correction_);
  if (loops_) loops_->begin_map();
  begin.level = generation.level;
  map_.begin(std::move(begin));
  if (!generation.level.is_level()) map_.correct(correction_, num_corrections_);
}

/// Where the frame stands in the map; lost for those who look on while that is unknown.
void Pipeline::put_into_map(std::int64_t timestamp_ns, FrontEndResult& result) const {
  Tracking& tracking = result.tracking;
  result.world_from_camera = path_.place(timestamp_ns, tracking.segment, *result.world_from_camera);
  if (result.world_from_camera) return;
  tracking.state = TrackingState::lost;
  tracking.reason = kPlaceUnknown;
}

void Pipeline::report(const Captured& captured, FrontEndResult& result) {
  statistics_.add(Stage::rectify, result.times.rectify_ms);
  statistics_.add(Stage::disparity, result.times.disparity_ms);
  statistics_.add(Stage::odometry, result.times.odometry_ms);
  const std::int64_t timestamp_ns = captured.frame->timestamp_ns;
  {
    const std::scoped_lock lock(counters_mutex_);
    ++counters_.frames;
    counters_.tracked += result.tracking.has_pose() ? 1 : 0;
    counters_.lost += result.tracking.state == TrackingState::lost ? 1 : 0;
    if (result.world_from_camera) put_into_map(timestamp_ns, result);
    counters_.warnings = {result.tracking.reason, words_of_row_offset(result.row_offset_px)};
    std::erase(counters_.warnings, "");
  }
  TrackingReport tracked;
  tracked.timestamp_ns = timestamp_ns;
  tracked.world_from_camera = result.world_from_camera;
  tracked.tracking = std::move(result.tracking);
  tracked.mapped = !result.views.empty();
  tracked.latency_ms = ms_since(captured.at);
  observer_.frame_tracked(tracked);
  observer_.pictures_taken({timestamp_ns, result.rectified, result.disparity});
}

void Pipeline::report_status() {
  const auto now = Clock::now();
  StatusReport report = status();
  const double seconds = std::chrono::duration<double>(now - status_at_).count();
  if (status_at_ != Clock::time_point{} && seconds > 0) {
    report.frames_per_s = static_cast<double>(report.frames - frames_at_status_) / seconds;
  }
  status_at_ = now;
  frames_at_status_ = report.frames;
  report.alignment = front_end_.alignment();
  if (!correction_.level().is_level()) report.alignment += ", then levelled by hand";
  report.processor_celsius = heat_.read();
  if (std::string hot = heat_.warning(); !hot.empty()) report.warnings.push_back(std::move(hot));
  observer_.status_changed(report);
}

StatusReport Pipeline::status() const {
  std::unique_lock lock(counters_mutex_);
  StatusReport report = counters_;
  report.warnings.insert(report.warnings.end(), source_warnings_.begin(), source_warnings_.end());
  lock.unlock();
  const std::uint64_t unplaced = unplaced_frames_;
  report.tracked -= unplaced;
  report.lost += unplaced;
  report.waiting_views = map_.num_waiting();
  report.loops = loops_ ? loops_->num_loops() : 0;
  report.dropped_frames = frames_.dropped();
  report.stages = statistics_.report();
  report.queues = {{"frames", frames_.size()}, {"views", map_.num_queued()}};
  report.queues.push_back({"loop", loops_ ? loops_->num_queued() : 0});
  return report;
}

}  // namespace flogmap
