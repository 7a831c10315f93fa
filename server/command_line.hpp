// The edges of a command line that CLI11 leaves: its first word, words too many, output that is lost.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace flogmap {

/// Throws UsageError unless `word` is one of these commands, or asks for help or version; CLI11 would say
/// only that a command is missing.
void check_first_word(const std::string& word, const std::vector<std::string>& commands);

/// The words that nothing takes, in the order given.
std::string unexpected_words(const CLI::App& app);

/// Writes out what was printed; false if it could not be written, to a full disk for instance.
bool flush_output();

}  // namespace flogmap
