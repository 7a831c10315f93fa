#include "server/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>

#include "server/option_table.hpp"

namespace flogmap {

void check_first_word(const std::string& word, const std::vector<std::string>& commands) {
  if (word == "-h" || word == "--help" || word == "--version") return;
  if (std::find(commands.begin(), commands.end(), word) != commands.end()) return;
  std::string allowed;
  for (const std::string& command : commands) allowed += (allowed.empty() ? "" : "|") + command;
  const std::string fault = word.empty() ? "a command is missing" : "'" + word + "' is no command";
  throw UsageError(fault + "; allowed: " + allowed + "; or --help, --version");
}

std::string unexpected_words(const CLI::App& app) {
  std::string words;
  for (const std::string& word : app.remaining(true)) words += " '" + word + "'";
  return "not expected:" + words;
}

bool flush_output() {
  std::cout.flush();
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good();
}

}  // namespace flogmap
