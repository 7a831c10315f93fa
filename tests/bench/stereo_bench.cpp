// Accuracy and time of our matchers and OpenCV's in one run:
//   FLOGMAP_DATA=... stereo_bench [--json FILE] [--markdown FILE] [--rounds N]
// Every matcher runs on one thread; cpu_ms is the least CPU time of N rounds. The scores with "filtered" are
// after remove_small_segments(), for all matchers alike: that is what the map sees.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "mapping/stereo/disparity_matcher.hpp"
#include "mapping/stereo/segment_filter.hpp"
#include "tests/bench/stereo_bench_opencv.hpp"
#include "tests/bench/stereo_bench_pairs.hpp"
#include "tests/bench/stereo_bench_score.hpp"

namespace flogmap {
namespace {

struct Arguments {
  std::string json = "build/bench/stereo.json";
  std::string markdown;
  int rounds = 5;
};

struct Result {
  std::string pair, matcher;
  StereoScore raw, filtered;
  double cpu_ms = 0;
};

const std::vector<std::string> kMatchers{"block", "sgm", "cvbm", "cvsgbm3", "cvhh4"};

double cpu_ms_now() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

std::unique_ptr<DisparityMatcher> matcher_called(const std::string& name, const BenchPair& pair) {
  if (name == "cvbm") return make_opencv_matcher(OpenCvMode::bm, pair.num_disparities);
  if (name == "cvsgbm3") return make_opencv_matcher(OpenCvMode::sgbm_3way, pair.num_disparities);
  if (name == "cvhh4") return make_opencv_matcher(OpenCvMode::sgbm_hh4, pair.num_disparities);
  const MatcherKind kind = name == "block" ? MatcherKind::block : MatcherKind::sgm;
  return make_matcher({.matcher = kind, .num_disparities = pair.num_disparities, .num_threads = 1},
                      pair.camera);
}

Result measure(const BenchPair& pair, const std::string& name, int rounds) {
  Result result{.pair = pair.name, .matcher = name, .raw = {}, .filtered = {}, .cpu_ms = 1e9};
  const auto matcher = matcher_called(name, pair);
  DisparityImage disparity;
  for (int i = 0; i < rounds; ++i) {
    const double start = cpu_ms_now();
    disparity = matcher->match(pair.frame);
    result.cpu_ms = std::min(result.cpu_ms, cpu_ms_now() - start);
  }
  result.raw = score(disparity, pair);
  const StereoCamera size{.width_px = disparity.px.width, .height_px = disparity.px.height};
  remove_small_segments(disparity, min_segment_px({}, size));
  result.filtered = score(disparity, pair);
  return result;
}

/// "12.3", or a dash where there is no truth.
std::string number(double value, int digits = 1) {
  if (std::isnan(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string markdown_row(const Result& r) {
  const bool has_spikes = r.filtered.textured_density > 0;
  return "| " + r.pair + " | " + r.matcher + " | " + number(r.raw.bad2_visible) + " | " +
         number(r.raw.bad2_answered) + " | " + number(r.raw.density) + " | " +
         number(r.filtered.bad2_visible) + " | " + number(r.filtered.bad2_answered) + " | " +
         number(r.filtered.density) + " | " + number(r.filtered.median_px, 3) + " | " +
         number(r.filtered.bias_px, 3) + " | " + (has_spikes ? number(r.filtered.spikes_per_10k) : "-") +
         " | " + (has_spikes ? number(r.filtered.textured_density) : "-") + " | " + number(r.cpu_ms) + " |\n";
}

std::string markdown(const std::vector<Result>& results) {
  std::string out =
      "# Stereo, measured\n\nWritten by `scripts/bench stereo` (`stereo_bench --markdown`). One thread; CPU "
      "time is the "
      "least of several rounds.\n`block` and `sgm` are ours; `cvbm` (9 x 9), `cvsgbm3` (3-way, 3 x 3) and "
      "`cvhh4` are "
      "OpenCV's with padded borders.\nBad: off by more than 2 px. Of the visible pixels a missing answer "
      "counts as "
      "bad; of the answers all are counted,\nin occluded places too. tsukuba has no mask of visible pixels. "
      "Filtered: after the segment filter, the same for all.\nMedian and bias of the errors within 1 px. "
      "Spikes: "
      "answers more than 4 px from a depth edge that are too near by more\nthan 3 m (FLOG.md's m = 3 dl), "
      "per 10,000. "
      "Textured: answered share of the visible pixels on textured surfaces.\n\n| pair | matcher | bad % of "
      "visible | "
      "bad % of answers | density % | filtered: visible | answers | density | median px | bias px | spikes | "
      "textured "
      "% | CPU ms |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Result& result : results) out += markdown_row(result);
  return out;
}

void add_json(const std::string& key, double value, std::string& out) {
  if (std::isnan(value)) return;
  out += (out.empty() ? "{\n" : ",\n") + ("  \"" + key + "\": ") + number(value, 4);
}

std::string json(const std::vector<Result>& results) {
  std::string out;
  for (const Result& r : results) {
    const std::string key = r.pair + "_" + r.matcher + "_";
    add_json(key + "bad2_visible", r.raw.bad2_visible, out);
    add_json(key + "bad2_answered", r.raw.bad2_answered, out);
    add_json(key + "density", r.raw.density, out);
    add_json(key + "cpu_ms", r.cpu_ms, out);
    add_json(key + "filtered_bad2_visible", r.filtered.bad2_visible, out);
    add_json(key + "filtered_bad2_answered", r.filtered.bad2_answered, out);
    add_json(key + "filtered_density", r.filtered.density, out);
    if (r.filtered.textured_density > 0) add_json(key + "spikes_per_10k", r.filtered.spikes_per_10k, out);
    if (r.filtered.textured_density > 0) add_json(key + "textured_density", r.filtered.textured_density, out);
  }
  return out + "\n}\n";
}

void write(const std::string& file, const std::string& text) {
  if (file.empty()) return;
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  std::ofstream out(file);
  out << text;
  if (!out.flush()) throw std::runtime_error(file + ": cannot be written");
}

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; i += 2) {
    const std::string name = argv[i];
    const std::string value = i + 1 < argc ? argv[i + 1] : "";
    if (name == "--json")
      arguments.json = value;
    else if (name == "--markdown")
      arguments.markdown = value;
    else if (name == "--rounds")
      arguments.rounds = std::max(1, std::atoi(value.c_str()));
    else
      throw std::runtime_error(name + ": allowed are --json FILE, --markdown FILE, --rounds N");
  }
  return arguments;
}

int run(const Arguments& arguments) {
  const char* data = std::getenv("FLOGMAP_DATA");
  if (!data) throw std::runtime_error("FLOGMAP_DATA: not set; it names the folder with the recordings");
  std::vector<Result> results;
  std::printf("%-10s %-8s %8s %8s %8s %8s\n", "pair", "matcher", "visible", "answers", "density", "cpu_ms");
  for (const BenchPair& pair : load_bench_pairs(data)) {
    for (const std::string& matcher : kMatchers) {
      const Result& r = results.emplace_back(measure(pair, matcher, arguments.rounds));
      std::printf("%-10s %-8s %8s %8s %8s %8s\n", r.pair.c_str(), r.matcher.c_str(),
                  number(r.raw.bad2_visible).c_str(), number(r.raw.bad2_answered).c_str(),
                  number(r.raw.density).c_str(), number(r.cpu_ms).c_str());
    }
  }
  write(arguments.json, json(results));
  write(arguments.markdown, markdown(results));
  return 0;
}

}  // namespace
}  // namespace flogmap

int main(int argc, char** argv) {
  try {
    return flogmap::run(flogmap::parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stereo_bench: %s\n", error.what());
    return 2;
  }
}
