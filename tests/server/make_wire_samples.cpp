// make_wire_samples FOLDER: writes the golden wire samples anew. Only after a wanted change of the format.
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>

#include "tests/server/wire_samples.hpp"

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_wire_samples tests/golden/wire\n");
    return 2;
  }
  const std::string folder = std::string(argv[1]) + "/";
  auto samples = flogmap::server_samples();
  for (const auto& sample : flogmap::client_samples()) samples.push_back(sample);
  for (const auto& sample : samples) {
    std::ofstream(folder + sample.name + ".bin", std::ios::binary) << sample.bytes;
    std::ofstream(folder + sample.name + ".json") << flogmap::to_json(sample);
  }
  std::printf("%zu samples\n", samples.size());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "make_wire_samples: %s\n", error.what());
  return 1;
}
