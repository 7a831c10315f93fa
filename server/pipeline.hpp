// THE composition: threads and queues between source, front end and map. Print this and
// mapping/front_end.cpp, and you know the program.
#pragma once

#include <chrono>
#include <exception>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "camera/stereo_source.hpp"
#include "mapping/flog/map_integrator.hpp"
#include "mapping/front_end.hpp"
#include "server/bounded_queue.hpp"
#include "server/capture_control.hpp"
#include "server/publication.hpp"
#include "server/stage_statistics.hpp"

namespace flogmap {

/// Who hears what the pipeline finds: the hub and the store of `serve`, the files of `map`. Calls come from
/// the vision and the map thread and must return soon.
class PipelineObserver {
 public:
  virtual ~PipelineObserver() = default;
  virtual void map_begins(const MapBegin& begin) = 0;  // before anything else of that map, path included
  virtual void map_changed(std::uint64_t revision, const std::vector<TileUpdate>& updates) = 0;
  virtual void view_mapped(const View& /*view*/) {}  // its cells have just been told by map_changed()
  virtual void path_grew(const std::vector<TrajectoryEntry>& entries) = 0;
  virtual void frame_tracked(const TrackingReport& report) = 0;
  virtual void pictures_taken(const PictureReport& report) = 0;
  virtual void status_changed(const StatusReport& report) = 0;
};

/// The map that the first frames continue; empty for a fresh one.
struct ContinuedMap {
  std::string epoch;
  std::vector<TileUpdate> tiles;
  std::vector<TrajectoryEntry> trajectory;
};

struct PipelineOptions {
  double rate = 1;               // 1 as recorded, 0 as fast as possible
  bool loop = false;             // a recording starts again at its end
  bool end_with_source = false;  // batch: wait() returns when the recording has ended
  std::int64_t max_frames = 0;   // the source counts as ended after so many; 0 = never
  std::size_t statistics_window = 256;
  ContinuedMap continued;
};

/// source -> frames[2] -> front end -> views[4] -> map -> observer. Three threads, each owning its part
/// outright.
class Pipeline {
 public:
  Pipeline(const PipelineOptions& options, std::unique_ptr<StereoSource> source, FrontEnd front_end,
           MapIntegrator integrator, PipelineObserver& observer);
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  void start();
  /// Ends downstream: source, then each stage once its queue is drained. From any thread, at once.
  void stop();
  /// Blocks until every stage has ended; rethrows what a stage threw.
  void wait();

  [[nodiscard]] SessionControl& control() { return control_; }
  [[nodiscard]] StatusReport status() const;
  [[nodiscard]] const MapIntegrator& integrator() const { return integrator_; }  // after wait()

 private:
  /// Frames of one generation belong to one map; a reset or a jump back in time begins the next.
  struct Generation {
    std::uint64_t number = 0;
    std::string epoch;
    std::string reason;
  };
  struct Captured {
    Generation generation;
    std::optional<StereoFrame> frame;  // nothing: the generation is new, or ...
    bool ended = false;                // ... the source has ended
    std::chrono::steady_clock::time_point at;
  };
  struct ForMap {
    std::optional<View> view;
    std::optional<Generation> generation;  // begin this map, then open `begun`
    std::shared_ptr<std::promise<void>> begun;
  };

  void capture();
  bool read_frame();
  void restart(const std::string& reason, double position_s);
  void go_to(double position_s);
  void at_end();
  void see();
  void begin_generation(const Generation& generation);
  void pass_on(FrontEndResult& result);
  void report(const Captured& captured, FrontEndResult& result);
  void report_status();
  void map();
  void begin_map(const Generation& generation);
  template <typename Stage>
  void run_stage(Stage stage);

  const PipelineOptions options_;
  std::unique_ptr<StereoSource> source_;
  FrontEnd front_end_;
  MapIntegrator integrator_;
  PipelineObserver& observer_;
  CaptureControl control_;
  StageStatistics statistics_;
  BoundedQueue<Captured> frames_;
  BoundedQueue<ForMap> views_;

  Generation generation_;              // capture thread
  std::int64_t frames_read_ = 0;       // of this generation
  std::uint64_t seen_generation_ = 0;  // vision thread
  std::chrono::steady_clock::time_point status_at_;
  std::uint64_t frames_at_status_ = 0;

  mutable std::mutex counters_mutex_;
  StatusReport counters_;
  SkippedFrames skipped_;
  std::exception_ptr failure_;
  std::vector<std::jthread> threads_;
};

}  // namespace flogmap
