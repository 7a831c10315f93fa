#include "server/map_stage.hpp"

#include <chrono>
#include <utility>

namespace flogmap {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kQueue = 4;
constexpr std::chrono::seconds kLastCatchUp{4};  // of a server that ends

}  // namespace

MapStage::MapStage(MapBuilder builder, PipelineObserver& observer, StageStatistics& statistics, bool batch,
                   std::function<bool()> ending)
    : builder_(std::move(builder)),
      observer_(observer),
      statistics_(statistics),
      batch_(batch),
      ending_(std::move(ending)),
      items_(kQueue, WhenFull::wait),
      whole_(builder_.is_whole()) {}

void MapStage::integrate(View view) {
  Item item;
  item.view = std::move(view);
  items_.push(std::move(item));
}

void MapStage::correct(PathCorrection correction, std::uint64_t number) {
  Item item;
  item.correction = std::move(correction);
  item.number = number;
  items_.push(std::move(item));
}

void MapStage::begin(MapBegin map) {
  Item item;
  item.begin = std::move(map);
  wait_for(std::move(item));
}

void MapStage::wait_for_rest() {
  Item item;
  item.rest = true;
  wait_for(std::move(item));
}

void MapStage::wait_for(Item item) {
  item.reached = std::make_shared<std::promise<void>>();
  std::future<void> done = item.reached->get_future();
  if (items_.push(std::move(item))) done.get();
}

void MapStage::run() {
  while (std::optional<Item> item = next()) take_in(*item);
  const auto deadline = Clock::now() + kLastCatchUp;
  while (builder_.is_behind() && (batch_ || Clock::now() < deadline)) catch_up();
}

/// As long as nothing comes, the map catches up with the newest correction; in batch that is for the end.
std::optional<MapStage::Item> MapStage::next() {
  while (builder_.is_behind() && !batch_ && !ending_()) {
    catch_up();
    if (std::optional<Item> item = items_.try_pop()) return item;
  }
  return items_.pop();
}

void MapStage::take_in(Item& item) {
  if (item.begin) {
    begin_now(*item.begin);
  } else if (item.correction) {
    builder_.correct(*std::move(item.correction));
    newest_number_ = item.number;
  } else if (item.rest) {
    while (builder_.is_behind() && !batch_ && !ending_()) catch_up();
  } else {
    take_in(*item.view);
  }
  num_waiting_ = builder_.num_waiting();
  whole_ = builder_.is_whole();
  if (item.reached) item.reached->set_value();
}

void MapStage::take_in(View& view) {
  const auto start = Clock::now();
  const std::vector<TileUpdate> updates = builder_.add(view);
  statistics_.add(Stage::map, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  if (updates.empty()) return;
  observer_.map_changed(builder_.map().revision(), updates);
  observer_.view_mapped(view);
}

void MapStage::begin_now(MapBegin& map) {
  if (std::exchange(begun_, true)) builder_.reset();
  map.info = builder_.map().info();
  map.revision = builder_.map().revision();
  observer_.map_begins(map);
}

void MapStage::catch_up() {
  const std::vector<TileUpdate> updates = builder_.catch_up();
  if (!updates.empty()) observer_.map_changed(builder_.map().revision(), updates);
  if (!builder_.is_behind()) observer_.map_caught_up(newest_number_);
}

std::string MapStage::why_not_levelled() const {
  if (whole_) return {};
  return "parts of this map were seen before the last start, or so long ago that their views are no longer "
         "kept; reset the map, then level it";
}

}  // namespace flogmap
