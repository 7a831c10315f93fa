// flogmap_experiments OUT [NAME ...]: runs the experiments and writes OUT/README.md with their pictures. With
// names, only those, for a look; the report is then printed, not written.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <functional>
#include <set>

#include "tests/experiments/experiments.hpp"

namespace flogmap::experiments {
namespace {

struct Experiment {
  const char* name;
  Report (*run)(Workshop&);
};

constexpr Experiment kExperiments[] = {
    {"two_boxes", two_boxes},
    {"side_widths", side_widths},
    {"hidden_sides", hidden_sides},
    {"layer_heights", layer_heights},
    {"hand_held", hand_held},
    {"segment_filter", segment_filter},
    {"row_steps", row_steps},
    {"table_layers", table_layers},
    {"removed_box", removed_box},
    {"repeated_views", repeated_views},
    {"bayesian_grid", bayesian_grid},
    {"paper_mode", paper_mode},
    {"speed", speed},
};

constexpr const char* kIntroduction = R"(# The paper's experiments, reproduced and extended
Written by `scripts/experiments`, which renders the scenes, runs the program on them and measures; nothing here is typed by
hand. "Another renderer" are recordings that are not part of this project; their rows are left out where `FLOGMAP_DATA`
does not name their folder. In the maps black is occupied, white is free or unknown, as in the paper.

The truth is exact: a cell is occupied if a solid overlaps its box, seen if a ray of the camera ended on a surface in it. F1
of occupied cells joins precision (cells called occupied within 2 cells of a solid) and recall (surfaces seen within 2
cells of one called occupied). A cell is called occupied by the rule of the trinary map: at least 8 rays, and a map value
of at least 0.3 with full confidence.

)";

/// The report of one experiment, with how long it took on the error stream.
std::string run(const Experiment& experiment, Workshop& workshop) {
  std::fprintf(stderr, "%s ...\n", experiment.name);
  const auto start = std::chrono::steady_clock::now();
  std::string page = markdown(experiment.run(workshop));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::fprintf(stderr, "%s: %.1f s\n", experiment.name, took.count());
  return page;
}

void run_all(Workshop& workshop) {
  std::string page = kIntroduction;
  for (const Experiment& experiment : kExperiments) page += run(experiment, workshop);
  std::ofstream out(workshop.file("README.md"));
  out << page << std::flush;
  if (!out) throw std::runtime_error(workshop.file("README.md").string() + ": cannot be written");
}

int main_with(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: flogmap_experiments OUT [NAME ...]\n");
    return 2;
  }
  std::optional<std::filesystem::path> recordings;
  if (const char* folder = std::getenv("FLOGMAP_DATA")) recordings = folder;
  Workshop workshop(argv[1], recordings);
  const std::set<std::string> wanted(argv + 2, argv + argc);
  if (wanted.empty()) {
    run_all(workshop);
    return 0;
  }
  for (const Experiment& experiment : kExperiments) {
    if (wanted.contains(experiment.name)) std::fputs(run(experiment, workshop).c_str(), stdout);
  }
  return 0;
}

}  // namespace
}  // namespace flogmap::experiments

int main(int argc, char** argv) {
  try {
    return flogmap::experiments::main_with(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "flogmap_experiments: %s\n", error.what());
    return 1;
  }
}
