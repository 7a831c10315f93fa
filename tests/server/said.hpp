// What the program says when it is run once.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace flogmap {

struct Said {
  int code = 0;
  std::string out, err;
};

inline std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Runs `before flogmap arguments` by the shell in a folder; `before` may set variables.
inline Said run_in(const std::filesystem::path& folder, const std::string& arguments,
                   const std::string& before = "") {
  const std::string command = "cd " + folder.string() + " && " + before + " " FLOGMAP_PROGRAM " " + arguments;
  const int status = std::system(
      ("{ " + command + "; } >" + (folder / "out.txt").string() + " 2>" + (folder / "err.txt").string())
          .c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(folder / "out.txt"),
          text_of(folder / "err.txt")};
}

}  // namespace flogmap
