#include "server/option_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "server/options.hpp"

namespace flogmap {
namespace {

using ::testing::HasSubstr;

/// A table of three options, fed from all sides.
class OptionTableTest : public ::testing::Test {
 protected:
  void SetUp() override {
    table_.number("cell-size", "METRES", cell_size_, 0.002, 1, "side of a cell");
    table_.flag("paper-mode", paper_mode_, "literally");
    table_.add({.name = "layers",
                .value_name = "Z",
                .help = "boundaries",
                .parse = [this](const std::string& text) { layers_ = parse_numbers(text, 0); },
                .show = [] { return std::string(); }});
    table_.attach(app_);
  }
  void TearDown() override { unsetenv("FLOGMAP_CELL_SIZE"); }

  void parse(const std::vector<std::string>& arguments) {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    app_.parse(reversed);
    table_.apply({"listen"});
  }

  std::string config(const std::string& text) {
    const auto path = std::filesystem::path(::testing::TempDir()) / "flogmap_option_table_test.json";
    std::ofstream(path) << text;
    return path.string();
  }

  std::string failure(const std::vector<std::string>& arguments) {
    try {
      parse(arguments);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "accepted";
  }

  double cell_size_ = 0.02;
  bool paper_mode_ = false;
  std::vector<double> layers_;
  OptionTable table_;
  CLI::App app_;
};

TEST_F(OptionTableTest, CommandLineWinsOverEnvironmentOverFileOverDefault) {
  const std::string file = config(R"({"cell-size": 0.03})");
  parse({"--config", file});
  EXPECT_DOUBLE_EQ(cell_size_, 0.03);
  setenv("FLOGMAP_CELL_SIZE", "0.04", 1);
  table_.apply({});
  EXPECT_DOUBLE_EQ(cell_size_, 0.04);
  parse({"--config", file, "--cell-size", "0.05"});
  EXPECT_DOUBLE_EQ(cell_size_, 0.05);
  EXPECT_EQ(table_.effective()["cell-size"]["origin"], "command line");
}

TEST_F(OptionTableTest, JsonValuesOfEveryKindAreTaken) {
  parse({"--config", config(R"({"cell_size": "0.1", "paper-mode": true, "layers": [0.1, 0.5, 1]})")});
  EXPECT_DOUBLE_EQ(cell_size_, 0.1);
  EXPECT_TRUE(paper_mode_);
  EXPECT_EQ(layers_, (std::vector<double>{0.1, 0.5, 1}));
}

TEST_F(OptionTableTest, ErrorsNameFileKeyValueAndWhatIsAllowed) {
  const std::string file = config(R"({"cell-size": -1})");
  const std::string message = failure({"--config", file});
  EXPECT_THAT(message, HasSubstr(file));
  EXPECT_THAT(message, HasSubstr("cell-size"));
  EXPECT_THAT(message, HasSubstr("-1"));
  EXPECT_THAT(message, HasSubstr("0.002 to 1"));
}

TEST_F(OptionTableTest, UnknownKeysAreRefusedButThoseOfOtherCommandsPassedOver) {
  EXPECT_THAT(failure({"--config", config(R"({"cel-size": 0.02})")}), HasSubstr("unknown key 'cel-size'"));
  EXPECT_THAT(failure({"--config", config(R"({"cel\nsize": 0.02})")}), HasSubstr("unknown key 'cel size'"));
  EXPECT_EQ(failure({"--config", config(R"({"listen": "127.0.0.1:1"})")}), "accepted");
}

TEST_F(OptionTableTest, BrokenAndMissingFilesAreSaid) {
  EXPECT_THAT(failure({"--config", config("{")}), HasSubstr("not JSON"));
  EXPECT_THAT(failure({"--config", config("[1]")}), HasSubstr("one JSON object"));
  EXPECT_THAT(failure({"--config", "/no/such/file.json"}), HasSubstr("/no/such/file.json"));
  EXPECT_THAT(failure({"--config", ::testing::TempDir()}),
              HasSubstr("--config " + ::testing::TempDir() + ": is a folder"));
}

TEST_F(OptionTableTest, NumbersAreReadWholeOrNotAtAll) {
  for (const char* bad : {"", "abc", "0.02x", "nan", "inf", "1e999", "2", "0"}) {
    EXPECT_NE(failure({"--cell-size", bad}), "accepted") << bad;
  }
}

TEST(Options, EveryDefaultReadsBackFromItsOwnText) {
  Options options;
  OptionTable table;
  add_source_options(table, options);
  add_mapping_options(table, options);
  add_serve_options(table, options);
  const nlohmann::json effective = table.effective();
  for (const auto& [name, entry] : effective.items()) {
    const auto text = entry["value"].get<std::string>();
    if (text.empty()) continue;  // not set
    EXPECT_NO_THROW(table.set(name, text, "test")) << name << " = " << text;
    EXPECT_EQ(table.effective()[name]["value"], text) << name;
  }
}

TEST(Options, ImpossibleLayersAreNamed) {
  Options options;
  OptionTable table;
  add_mapping_options(table, options);
  EXPECT_THROW(table.set("layers", "1,0.5", "test"), UsageError);
  EXPECT_THROW(table.set("layers", "1", "test"), UsageError);
}

TEST(Options, HostsAndOriginsThatCannotBeAreRefused) {
  Options options;
  OptionTable table;
  add_listen_options(table, options);
  for (const char* host : {"a b", "http://a", "a/b", "a:b", "*"})
    EXPECT_THROW(table.set("allow-host", host, "test"), UsageError) << host;
  for (const char* origin : {"foo", "robot.lan", "https://", "https://a/b", "https://a b", "a,https://b"})
    EXPECT_THROW(table.set("allow-origin", origin, "test"), UsageError) << origin;
  table.set("allow-host", "robot.lan,10.0.0.7:8080,[fe80::1]:80", "test");
  table.set("allow-origin", "https://robot.lan:8443,http://[::1],app://page", "test");
  EXPECT_EQ(options.serve.allow_hosts.size(), 3U);
  EXPECT_EQ(options.serve.allow_origins.size(), 3U);
}

}  // namespace
}  // namespace flogmap
