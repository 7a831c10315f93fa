// Options as a table: each has one name for the command line (--cell-size), the environment
// (FLOGMAP_CELL_SIZE) and the config file ("cell-size"), one text form, and remembers where its value came
// from.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace flogmap {

/// Bad usage or input: one line for the user, exit code 2.
class UsageError : public std::runtime_error {
 public:
  /// Always one line: keys and values of a file may hold line breaks, which become spaces.
  explicit UsageError(std::string message) : std::runtime_error(on_one_line(std::move(message))) {}

 private:
  static std::string on_one_line(std::string text) {
    for (char& c : text) {
      if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    }
    return text;
  }
};

struct Option {
  std::string name;        // without dashes: "cell-size"
  std::string value_name;  // for --help: "METRES"; empty for a switch
  std::string help;
  std::function<void(const std::string&)> parse;  // throws UsageError saying what is allowed
  std::function<std::string()> show;              // the value in effect, as text
  bool secret = false;                            // masked where values are shown
  std::string origin = "default";                 // default, "FILE", "environment", "command line"
};

class OptionTable {
 public:
  void text(const std::string& name, const std::string& value_name, std::string& target,
            const std::string& help);
  /// `low` <= value <= `high`.
  void number(const std::string& name, const std::string& value_name, double& target, double low, double high,
              const std::string& help);
  void integer(const std::string& name, const std::string& value_name, int& target, int low, int high,
               const std::string& help);
  void on_off(const std::string& name, bool& target, const std::string& help);
  void flag(const std::string& name, bool& target, const std::string& help);
  void add(Option option) { options_.push_back(std::move(option)); }

  /// One of several words, each with its value.
  template <typename T>
  void choice(const std::string& name, T& target, const std::vector<std::pair<std::string, T>>& words,
              const std::string& help) {
    std::string allowed;
    for (const auto& word : words) allowed += (allowed.empty() ? "" : "|") + word.first;
    const auto parse = [&target, words, allowed](const std::string& given) {
      for (const auto& [word, value] : words) {
        if (word == given) {
          target = value;
          return;
        }
      }
      throw UsageError("allowed: " + allowed);
    };
    const auto show = [&target, words] {
      for (const auto& [word, value] : words) {
        if (value == target) return word;
      }
      return std::string();
    };
    add({.name = name, .value_name = allowed, .help = help, .parse = parse, .show = show});
  }

  /// Makes the command line accept these options; values are kept until apply().
  void attach(CLI::App& app);

  /// Takes over config file (--config, if given), environment and command line, in rising order.
  /// Throws UsageError naming file or variable, key, value and what is allowed. Keys that only
  /// `known_elsewhere` has belong to other commands and are passed over.
  void apply(const std::vector<std::string>& known_elsewhere);

  void set(const std::string& name, const std::string& value, const std::string& origin);
  [[nodiscard]] bool is_default(const std::string& name) const;
  [[nodiscard]] std::vector<std::string> names() const;

  /// {"cell-size": {"value": "0.02", "origin": "default"}, ...}
  [[nodiscard]] nlohmann::json effective() const;

 private:
  Option* find(const std::string& name);
  void apply_file(const std::vector<std::string>& known_elsewhere, const std::string& named_by);
  void apply_environment(const std::vector<std::string>& known_elsewhere);

  std::vector<Option> options_;
  std::string config_file_;
  std::vector<std::pair<std::string, std::string>> from_command_line_;
};

/// "1,2,3" as numbers; throws UsageError unless there are `count` of them (0 = any number).
std::vector<double> parse_numbers(const std::string& text, std::size_t count);

}  // namespace flogmap
