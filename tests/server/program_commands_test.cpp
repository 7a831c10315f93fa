// The commands as they are called: where they write, what they refuse, and how they say it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "tests/camera/small_scene.hpp"
#include "tests/server/map_store_support.hpp"
#include "tests/server/said.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryFolder;

/// A folder with a short recording `rec` of a small scene and its map `map`.
class Commands : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder(TemporaryFolder::in_memory());
    std::ofstream(here() / "scene.json") << testing::kSmallScene;
    ASSERT_EQ(run("simulate --scene scene.json --frames 4 --depth-views 1 --out rec").code, 0);
    const Said mapped = run("map --source euroc:rec --out map");
    ASSERT_EQ(mapped.code, 0) << mapped.err;
  }
  static void TearDownTestSuite() { delete std::exchange(folder_, nullptr); }

  static fs::path here() { return folder_->path(); }
  static Said run(const std::string& arguments, const std::string& before = "") {
    return run_in(here(), arguments, before);
  }

  /// Bad usage: 2, and one line that holds this.
  static void refuses(const std::string& arguments, const std::string& words,
                      const std::string& before = "") {
    const Said said = run(arguments, before);
    EXPECT_EQ(said.code, 2) << arguments << ": " << said.err;
    EXPECT_THAT(said.err, HasSubstr(words)) << arguments;
    EXPECT_EQ(std::count(said.err.begin(), said.err.end(), '\n'), 1) << said.err;
    EXPECT_EQ(said.out, "") << arguments;
  }

  /// The first pair of the recording.
  static std::string pair() {
    std::set<fs::path> names;
    for (const auto& entry : fs::directory_iterator(here() / "rec/mav0/cam0/data"))
      names.insert(entry.path().filename());
    const std::string name = names.begin()->string();
    return "rec/mav0/cam0/data/" + name + " rec/mav0/cam1/data/" + name;
  }

 private:
  static TemporaryFolder* folder_;
};

TemporaryFolder* Commands::folder_ = nullptr;

TEST_F(Commands, WriteIntoTheCurrentFolderToo) {
  EXPECT_EQ(run("disparity " + pair() + " --out d.pfm").code, 0);
  EXPECT_EQ(run("export --store map/map.flog --format png --out x.png").code, 0);
  EXPECT_EQ(run("merge map/map.flog map/map.flog --out c.flog").code, 0);
  for (const char* file : {"d.pfm", "d.png", "x.png", "x.pgw", "c.flog"})
    EXPECT_TRUE(fs::exists(here() / file)) << file;
}

TEST_F(Commands, TakeTheirOptionsFromFileAndEnvironment) {
  std::ofstream(here() / "c.json")
      << R"({"scene": "scene.json", "frames": 2, "depth-views": 0, "listen": "x"})";
  EXPECT_EQ(run("simulate --config c.json --out two").code, 0);
  EXPECT_FALSE(fs::exists(here() / "two/depth"));
  EXPECT_EQ(run("simulate --out three", "FLOGMAP_SCENE=scene.json FLOGMAP_FRAMES=1").code, 0);
  EXPECT_EQ(run("export --out e.tum", "FLOGMAP_STORE=map/map.flog FLOGMAP_FORMAT=tum").code, 0);
  EXPECT_EQ(run("merge map/map.flog map/map.flog --out far.flog", "FLOGMAP_B_IN_A=9,0,0").code, 0);
  const Said score = run("evaluate --config c.json",
                         "FLOGMAP_JSON=on FLOGMAP_TRAJECTORY=map/trajectory.tum "
                         "FLOGMAP_GROUND_TRUTH=rec/groundtruth.tum");
  EXPECT_EQ(score.code, 0) << score.err;
  EXPECT_EQ(nlohmann::json::parse(score.out)["poses"], 4);
  refuses("simulate --out four", "FLOGMAP_FRAMES=-1", "FLOGMAP_SCENE=room FLOGMAP_FRAMES=-1");
  refuses("merge a b", "unknown variable FLOGMAP_NOSUCH", "FLOGMAP_NOSUCH=1");
  refuses("evaluate --config .", "--config .: is a folder");
  refuses("simulate --scene room --out x --seed -1", "--seed -1");
  refuses("map --source sim:room --out x", "FLOGMAP_LAYERS=1,0", "FLOGMAP_LAYERS=1,0");
}

/// A config file may serve several commands, so each has to know the others' keys.
TEST_F(Commands, KnowTheKeysOfAllCommands) {
  const std::regex option("--([a-z][a-z-]+)");
  nlohmann::json keys = nlohmann::json::object();
  for (const char* command : {"serve", "map", "disparity", "evaluate", "export", "merge", "simulate",
                              "record", "calibrate", "calib check", "cameras"}) {
    std::istringstream help(run(std::string(command) + " --help").out);
    for (std::string line; std::getline(help, line);) {
      std::smatch found;
      if (line.starts_with("  -") && std::regex_search(line, found, option)) keys[found[1]] = "1";
    }
  }
  for (const char* none : {"help", "config"}) keys.erase(none);
  EXPECT_GT(keys.size(), 60U);
  std::ofstream(here() / "all.json") << keys;
  EXPECT_THAT(run("cameras --config all.json").err, Not(HasSubstr("unknown key")));
  std::ofstream(here() / "none.json") << R"({"nosuch": 1})";
  refuses("cameras --config none.json", "unknown key 'nosuch'");
}

TEST_F(Commands, RefuseWhatHasNoMeaning) {
  const std::string from_store = "export --store map/map.flog ";
  refuses("nosuch", "'nosuch' is no command; allowed: serve|map|");
  refuses("--nosuch", "'--nosuch'");
  refuses("calib", "allowed: check");
  refuses("map --source sim:room --out x b a c", "'b' 'a' 'c'");
  refuses(from_store + "--format png --out x.png --layer -1", "--layer -1");
  refuses(from_store + "--format ply --out x.ply --layer 0", "--layer 0");
  refuses(from_store + "--format png --out x.png --scale", "--scale");
  refuses("evaluate --map map/map.flog --trajectory map/trajectory.tum", "one of them");
  refuses("merge map/map.flog map/map.flog --out x.flog --b-in-a 1e9,0,0", "--b-in-a 1e9,0,0: allowed: ");
  refuses("disparity " + pair() + " --out x.png", "must not end in .png");
  refuses("calibrate --left a --right b --out c.yaml --board 0x6", "--board 0x6: allowed");
  refuses("map --source 'images:missing*,missing*' --out x", "matches no picture");
  std::ofstream(here() / "tokens") << "view long-secret extra\n";
  refuses("serve --source sim:room --tokens tokens", "tokens:1");
  refuses("serve --source sim:room", "each role needs its own",
          "FLOGMAP_VIEW_TOKEN=long-secret FLOGMAP_CONTROL_TOKEN=long-secret");
}

TEST_F(Commands, RefuseWhereNothingCanBeWritten) {
  const std::string outputs[] = {"export --store map/map.flog --format tum --out ",
                                 "merge map/map.flog map/map.flog --out "};
  for (const std::string& command : outputs) {
    refuses(command + "none/x", "--out none/x");
    refuses(command + "rec", "--out rec: is a folder");
    refuses(command + "scene.json/x", "--out scene.json/x");
  }
  for (const std::string command :
       {"simulate --scene scene.json", "map --source euroc:rec", "record --source euroc:rec",
        "export --store map/map.flog --format ros"}) {
    refuses(command + " --out scene.json", "scene.json");
    refuses(command + " --out /proc/x", "/proc/x");
  }
  refuses("simulate --scene scene.json --out rec", "there is a recording already");
  refuses("record --source euroc:rec --out rec", "there is a recording already");
}

TEST_F(Commands, TakeTheSizeOfACalibrationThatHasNoneFromThePicture) {
  std::ofstream(here() / "calib.txt") << "P0: 210 0 159.5 0 0 210 119.5 0 0 0 1 0\n"
                                      << "P1: 210 0 159.5 -25.2 0 210 119.5 0 0 0 1 0\n";
  const Said said = run("disparity " + pair() + " --calibration calib.txt --out k.pfm");
  EXPECT_EQ(said.code, 0) << said.err;
  refuses("disparity " + pair() + " --calibration scene.json --out k.pfm", "scene.json");
}

TEST_F(Commands, CompareAMapOnlyWithTheTruthOfItsLayers) {
  EXPECT_EQ(run("map --source euroc:rec --out low --layers 0.05,0.5").code, 0);
  refuses("evaluate --map low/map.flog --truth rec/truth", "layer 0 of the map is 0.05 to 0.5 m");
  fs::copy(here() / "rec/truth", here() / "truth");
  nlohmann::json json = nlohmann::json::parse(text_of(here() / "truth/layer_1.json"));
  for (const auto& [key, value] : {std::pair("width", 7.0), {"cell", 1e-9}, {"cell", 1e9}}) {
    nlohmann::json wrong = json;
    wrong[key] = value;
    std::ofstream(here() / "truth/layer_1.json") << wrong;
    refuses("evaluate --map map/map.flog --truth truth", "truth/layer_1.json");
  }
}

TEST_F(Commands, FailIfWhatTheyPrintIsLost) {
  const std::string evaluate = "evaluate --trajectory map/trajectory.tum --ground-truth rec/groundtruth.tum";
  for (const char* end : {" >/dev/full", " --json >/dev/full"}) EXPECT_EQ(run(evaluate + end).code, 1) << end;
  EXPECT_EQ(run("--help >/dev/full").code, 1);
}

TEST_F(Commands, EndInOrderWhenInterrupted) {
  const std::string after = "timeout --preserve-status -s INT 3";
  EXPECT_EQ(run("record --source sim:scene.json --pictures pgm --out live", after).code, 0);
  EXPECT_TRUE(fs::exists(here() / "live/mav0/cam0/data.csv"));
  const Said simulated = run("simulate --scene scene.json --frames 100000 --out broken", after);
  EXPECT_EQ(simulated.code, 1);
  EXPECT_THAT(simulated.err, HasSubstr("interrupted"));
  EXPECT_EQ(run("simulate --scene scene.json --frames 1 --out broken").code, 0);
}

TEST_F(Commands, CountFramesWithoutAGivenPoseByThemselves) {
  std::istringstream all(text_of(here() / "rec/groundtruth.tum"));
  std::ofstream some(here() / "some.tum");
  std::string line;
  for (int i = 0; std::getline(all, line); ++i) {
    if (i != 2) some << line << '\n';
  }
  some.close();
  const Said said = run("map --source euroc:rec --poses some.tum --poses-frame rectified --out posed");
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("warning: 1 frames are not in the map: no pose is given"));
  EXPECT_THAT(said.out, Not(HasSubstr("warning")));
  const nlohmann::json stats = nlohmann::json::parse(text_of(here() / "posed/stats.json"));
  EXPECT_EQ(stats["without_pose"], 1);
  EXPECT_EQ(stats["lost"], 0);
  EXPECT_EQ(stats["tracked"], 3);
}

}  // namespace
}  // namespace flogmap
