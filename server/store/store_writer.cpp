#include "server/store/store_writer.hpp"

#include <iterator>
#include <utility>

namespace flogmap {
namespace {

/// Of views, what a disk that stands still may cost; a walkthrough can do without the others.
constexpr std::size_t kMaxWaitingViews = 256;

}  // namespace

void StoreMailbox::merge(StoreMailbox later) {
  if (later.begin) {
    *this = std::move(later);
    return;
  }
  for (auto& [index, update] : later.tiles) {
    TileUpdate& mine = tiles[index];
    if (!mine.tile || mine.revision < update.revision) mine = std::move(update);
  }
  if (later.path) {
    path = std::move(later.path);
    new_poses.clear();
  }
  new_poses.insert(new_poses.end(), std::make_move_iterator(later.new_poses.begin()),
                   std::make_move_iterator(later.new_poses.end()));
  if (later.caught_up) caught_up = later.caught_up;
  for (auto& [number, view] : later.views) {
    if (views.size() < kMaxWaitingViews || views.contains(number)) views[number] = std::move(view);
  }
}

StoreWriter::StoreWriter(MapStore store, std::string options_json, std::string calibration_json,
                         Milliseconds commit_every)
    : commit_every_(commit_every),
      options_json_(std::move(options_json)),
      calibration_json_(std::move(calibration_json)),
      store_(std::move(store)),
      state_{true, {}, store_.revision(), 0, 0},
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

StoreWriter::~StoreWriter() = default;

void StoreWriter::begin(MapBegin map) {
  StoreMailbox later;
  later.begin = std::move(map);
  post(std::move(later));
}

void StoreWriter::publish(const std::vector<TileUpdate>& updates) {
  StoreMailbox later;
  for (const TileUpdate& update : updates) later.tiles[update.index] = update;
  post(std::move(later));
}

void StoreWriter::append_trajectory(const std::vector<TrajectoryEntry>& entries) {
  StoreMailbox later;
  later.new_poses = entries;
  post(std::move(later));
}

void StoreWriter::rewrite_path(PathRewrite rewrite) {
  StoreMailbox later;
  later.path = std::move(rewrite);
  post(std::move(later));
}

void StoreWriter::caught_up(std::uint64_t number) {
  StoreMailbox later;
  later.caught_up = number;
  post(std::move(later));
}

void StoreWriter::put_view(SharedView view) {
  StoreMailbox later;
  later.views[view->number] = std::move(view);
  post(std::move(later));
}

StoreState StoreWriter::state() const {
  const std::scoped_lock lock(mutex_);
  StoreState state = state_;
  state.waiting_tiles = mailbox_.tiles.size() + tiles_in_work_;
  return state;
}

StoreState StoreWriter::flush() {
  {
    std::unique_lock lock(mutex_);
    hurry_ = true;
    if (!mailbox_.empty()) ++posted_;  // what was refused before is tried again
    changed_.notify_all();
    const std::uint64_t mine = posted_;
    changed_.wait(lock, [&] { return answered_ >= mine; });
  }
  return state();
}

void StoreWriter::post(StoreMailbox later) {
  if (later.empty()) return;
  const std::scoped_lock lock(mutex_);
  mailbox_.merge(std::move(later));
  ++posted_;
  changed_.notify_all();
}

/// Waits for mail, then lets more of it gather. False when the writer is to end.
bool StoreWriter::wait_for_mail(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, stop, [&] { return !mailbox_.empty(); });
  changed_.wait_for(lock, stop, commit_every_, [&] { return hurry_; });
  return !stop.stop_requested();
}

void StoreWriter::run(const std::stop_token& stop) {
  for (bool more = true; more;) {
    more = wait_for_mail(stop);
    std::unique_lock lock(mutex_);
    StoreMailbox batch = std::exchange(mailbox_, {});
    tiles_in_work_ = batch.tiles.size();
    const std::uint64_t newest = posted_;
    hurry_ = false;
    lock.unlock();
    if (!batch.empty()) write(std::move(batch));
    lock.lock();
    answered_ = newest;
    changed_.notify_all();
  }
}

void StoreWriter::write(StoreMailbox batch) {
  try {
    apply(batch);
    store_.commit();
    const std::scoped_lock lock(mutex_);
    tiles_in_work_ = 0;
    state_.ok = true;
    state_.problem.clear();
    state_.committed_revision = store_.revision();
    ++state_.commits;
  } catch (const std::exception& error) {
    refused(std::move(batch), error.what());
  }
}

void StoreWriter::apply(const StoreMailbox& batch) {
  if (batch.begin) {
    const MapBegin& map = *batch.begin;
    store_.begin({map.epoch, map.info, map.camera, map.revision, map.tiles, map.trajectory, options_json_,
                  calibration_json_, map.views, map.level});
  }
  std::vector<TileUpdate> updates;
  for (const auto& [index, update] : batch.tiles) updates.push_back(update);
  store_.put_tiles(updates);
  if (batch.path) {
    store_.rewrite_trajectory(batch.path->path);
    store_.put_level(batch.path->level);
    store_.set_behind(true);
    path_number_ = batch.path->number;
  }
  store_.append_trajectory(batch.new_poses);
  for (const auto& [number, view] : batch.views) store_.put_view(*view);
  if (batch.caught_up && *batch.caught_up >= path_number_) store_.set_behind(false);
}

/// What the disk refused waits for the next attempt, under what was published since.
void StoreWriter::refused(StoreMailbox batch, const std::string& why) {
  std::string problem = why + "; mapping goes on, the store is tried again";
  try {
    store_.rollback();
  } catch (const std::exception& error) {
    problem += std::string(" (") + error.what() + ")";
  }
  const std::scoped_lock lock(mutex_);
  batch.merge(std::exchange(mailbox_, {}));
  mailbox_ = std::move(batch);
  tiles_in_work_ = 0;
  state_.ok = false;
  state_.problem = std::move(problem);
}

}  // namespace flogmap
