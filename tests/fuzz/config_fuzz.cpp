// A configuration file is taken or refused with a UsageError of one line.
#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "server/options.hpp"
#include "tests/fuzz/scratch_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const flogmap::fuzz::ScratchFolder folder;
  static const std::vector<std::string> all = flogmap::all_option_names();
  const auto file = folder.write("config.json", {reinterpret_cast<const char*>(data), size});
  ::setenv("FLOGMAP_CONFIG", file.c_str(), 1);
  flogmap::Options options;
  flogmap::OptionTable table;
  flogmap::add_source_options(table, options);
  flogmap::add_mapping_options(table, options);
  flogmap::add_serve_options(table, options);
  try {
    table.apply(all);
    flogmap::settle(options);
    check(options.serve);
    (void)table.effective().dump();
  } catch (const flogmap::UsageError& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) ::abort();
  } catch (const std::runtime_error&) {  // check(ServeOptions); the command makes a UsageError of it
  }
  return 0;
}
