// flogmap cameras: what libcamera sees.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <vector>

#include "camera/live/camera_rig.hpp"
#include "server/commands/commands.hpp"
#include "server/options.hpp"

namespace flogmap {
namespace {

std::vector<CameraDescription> seen_cameras() {
  try {
    return list_cameras();
  } catch (const std::exception& error) {
    throw UsageError(error.what());
  }
}

int show_cameras() {
  const std::vector<CameraDescription> cameras = seen_cameras();
  for (const CameraDescription& camera : cameras) {
    std::printf("%s\n  model    %s\n", camera.id.c_str(), camera.model.empty() ? "-" : camera.model.c_str());
    for (const std::string& format : camera.formats) std::printf("  format   %s\n", format.c_str());
  }
  if (cameras.empty())
    std::printf(
        "libcamera sees no camera; is it plugged in, may this user open /dev/video* and /dev/media*?\n");
  if (cameras.size() >= 2)
    std::printf("for instance: flogmap serve --source 'libcamera:%s,%s' --calibration calib.yaml\n",
                cameras[0].id.c_str(), cameras[1].id.c_str());
  return 0;
}

}  // namespace

RunCommand add_cameras(CLI::App& app) {
  app.footer("Left and right are told by id, never by order: --source libcamera:LEFT_ID,RIGHT_ID");
  auto table =
      std::make_shared<OptionTable>();  // none of its own; a shared config file is checked all the same
  table->attach(app);
  return [table] {
    table->apply(all_option_names());
    return show_cameras();
  };
}

}  // namespace flogmap
