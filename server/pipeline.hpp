// THE composition: threads and queues between source, front end and map. Print this and
// mapping/front_end.cpp, and you know the program.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "camera/stereo_source.hpp"
#include "mapping/front_end.hpp"
#include "mapping/loop/corrected_path.hpp"
#include "server/bounded_queue.hpp"
#include "server/capture_control.hpp"
#include "server/loop_stage.hpp"
#include "server/map_stage.hpp"
#include "server/pipeline_observer.hpp"
#include "server/pipeline_options.hpp"
#include "server/processor_heat.hpp"
#include "server/stage_statistics.hpp"

namespace flogmap {

/// source -> frames[2] -> front end -> views[4] -> map -> observer, and views[4] -> loops -> corrections back
/// to where the path is kept. Four threads, each owning its part outright.
class Pipeline {
 public:
  Pipeline(const PipelineOptions& options, std::unique_ptr<StereoSource> source, FrontEnd front_end,
           MapIntegrator integrator, PipelineObserver& observer);
  ~Pipeline() { stop(); }
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  void start();
  /// Ends downstream: source, then each stage once its queue is drained. From any thread, at once.
  void stop();
  /// Blocks until every stage has ended; rethrows what a stage threw.
  void wait();

  [[nodiscard]] SessionControl& control() { return control_; }
  [[nodiscard]] StatusReport status() const;
  [[nodiscard]] const MapIntegrator& integrator() const { return map_.map(); }  // after wait()

 private:
  /// Frames of one generation belong to one map; a reset or a jump back in time begins the next.
  struct Generation {
    std::uint64_t number = 0;
    std::string epoch;
    std::string reason;
    HandLevel level;
  };
  struct Captured {
    Generation generation;
    std::optional<StereoFrame> frame;               // nothing: the generation is new, or ...
    bool ended = false;                             // ... the source has ended, or ...
    bool tell = false;                              // ... counts or warnings have changed, or ...
    std::optional<HandLevel> level = std::nullopt;  // ... the map is to be levelled so
    std::chrono::steady_clock::time_point at;
  };
  void capture();
  bool read_frame();
  void note_losses();
  void tell_counts();
  void tell_level();
  void restart(const std::string& reason, double position_s);
  void go_to(double position_s);
  void at_end();
  void see();
  void finish(const Generation& generation);
  void begin_generation(const Generation& generation);
  void pass_on(FrontEndResult& result);
  void put_into_map(std::int64_t timestamp_ns, FrontEndResult& result) const;
  void report(const Captured& captured, FrontEndResult& result);
  void wait_for_loops();
  void correct_path();
  void level_map(const HandLevel& level);
  void rewrite_path(const std::string& reason);
  void report_status();
  template <typename Stage>
  void run_stage(Stage stage);

  const PipelineOptions options_;
  std::unique_ptr<StereoSource> source_;
  FrontEnd front_end_;
  PipelineObserver& observer_;
  const std::string assumed_;  // as SourceInfo::assumed
  CaptureControl control_;
  StageStatistics statistics_;
  BoundedQueue<Captured> frames_;
  MapStage map_;                    // its queue holds 4 views, as does ...
  std::optional<LoopStage> loops_;  // ... this one's

  Generation generation_;              // capture thread
  std::int64_t frames_read_ = 0;       // of this generation
  std::uint64_t seen_generation_ = 0;  // vision thread, as is ...
  CorrectedPath path_;
  PathCorrection correction_;
  std::uint64_t num_corrections_ = 0;
  std::chrono::steady_clock::time_point status_at_;
  std::uint64_t frames_at_status_ = 0;
  ProcessorHeat heat_;

  mutable std::mutex counters_mutex_;
  StatusReport counters_;
  std::atomic<std::uint64_t> unplaced_frames_ = 0;  // that wait for their place
  std::vector<std::string> source_warnings_;
  std::exception_ptr failure_;
  std::vector<std::jthread> threads_;
};

}  // namespace flogmap
