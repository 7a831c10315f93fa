#include "server/option_table.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace flogmap {
namespace {

using nlohmann::json;

/// Variables of ours that are not options.
const std::vector<std::string> kOtherVariables{"data", "bin", "view-token", "control-token"};

double parse_number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw UsageError("'" + text + "' is not a number");
  }
  return value;
}

/// The shortest text that reads back as the same number.
std::string show_number(double value) {
  char text[32];
  const auto result = std::to_chars(text, text + sizeof text, value);
  return {text, result.ptr};
}

std::string range_text(double low, double high) { return show_number(low) + " to " + show_number(high); }

bool parse_on_off(const std::string& text) {
  if (text == "on" || text == "true" || text == "1") return true;
  if (text == "off" || text == "false" || text == "0") return false;
  throw UsageError("allowed: on|off");
}

std::string text_of(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
  if (value.is_number()) return value.dump();
  if (value.is_array()) {
    std::string text;
    for (const json& item : value) text += (text.empty() ? "" : ",") + text_of(item);
    return text;
  }
  throw UsageError("must be a string, a number, true, false or a list of them");
}

std::string with_dashes(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// `named_by`: the option or variable that names the file.
json read_json(const std::string& path, const std::string& named_by) {
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown))
    throw UsageError(named_by + " " + path + ": is a folder; must be a JSON file of options");
  std::ifstream file(path);
  if (!file) throw UsageError(named_by + " " + path + ": cannot be read; must be a JSON file of options");
  try {
    json document = json::parse(file, nullptr, true, true);
    if (!document.is_object()) throw UsageError(path + ": must be one JSON object of options");
    return document;
  } catch (const json::exception& error) {
    throw UsageError(path + ": not JSON: " + error.what());
  }
}

}  // namespace

std::vector<double> parse_numbers(const std::string& text, std::size_t count) {
  std::vector<double> numbers;
  std::size_t start = 0;
  while (start <= text.size()) {
    const std::size_t comma = std::min(text.find(',', start), text.size());
    numbers.push_back(parse_number(text.substr(start, comma - start)));
    start = comma + 1;
  }
  if (count > 0 && numbers.size() != count) {
    throw UsageError("needs " + std::to_string(count) + " numbers separated by commas, has " +
                     std::to_string(numbers.size()));
  }
  return numbers;
}

void OptionTable::text(const std::string& name, const std::string& value_name, std::string& target,
                       const std::string& help) {
  add({.name = name,
       .value_name = value_name,
       .help = help,
       .parse = [&target](const std::string& given) { target = given; },
       .show = [&target] { return target; }});
}

void OptionTable::number(const std::string& name, const std::string& value_name, double& target, double low,
                         double high, const std::string& help) {
  const auto parse = [&target, low, high](const std::string& given) {
    const double value = parse_number(given);
    if (value < low || value > high) throw UsageError("allowed: " + range_text(low, high));
    target = value;
  };
  add({.name = name, .value_name = value_name, .help = help, .parse = parse, .show = [&target] {
         return show_number(target);
       }});
}

void OptionTable::integer(const std::string& name, const std::string& value_name, int& target, int low,
                          int high, const std::string& help) {
  const auto parse = [&target, low, high](const std::string& given) {
    const double value = parse_number(given);
    if (value < low || value > high || value != std::floor(value)) {
      throw UsageError("allowed: whole numbers from " + range_text(low, high));
    }
    target = static_cast<int>(value);
  };
  add({.name = name, .value_name = value_name, .help = help, .parse = parse, .show = [&target] {
         return std::to_string(target);
       }});
}

void OptionTable::on_off(const std::string& name, bool& target, const std::string& help) {
  add({.name = name,
       .value_name = "on|off",
       .help = help,
       .parse = [&target](const std::string& given) { target = parse_on_off(given); },
       .show = [&target] { return std::string(target ? "on" : "off"); }});
}

void OptionTable::flag(const std::string& name, bool& target, const std::string& help) {
  on_off(name, target, help);
  options_.back().value_name.clear();
}

void OptionTable::attach(CLI::App& app) {
  app.add_option("--config", config_file_,
                 "JSON file of options; the command line and FLOGMAP_... win over it")
      ->type_name("FILE");
  for (const Option& option : options_) {
    const auto keep = [this, name = option.name](const std::string& value) {
      from_command_line_.emplace_back(name, value);
    };
    if (option.value_name.empty()) {
      app.add_flag_callback(
          "--" + option.name, [keep] { keep("on"); }, option.help);
      continue;
    }
    const std::string shown = option.show();
    app.add_option_function<std::string>("--" + option.name, keep, option.help)
        ->type_name(option.value_name + (shown.empty() || option.secret ? "" : " [" + shown + "]"));
  }
}

void OptionTable::apply(const std::vector<std::string>& known_elsewhere) {
  std::string named_by = "--config";
  if (config_file_.empty()) {
    if (const char* path = std::getenv("FLOGMAP_CONFIG")) config_file_ = path;
    named_by = "environment: FLOGMAP_CONFIG";
  }
  apply_file(known_elsewhere, named_by);
  apply_environment(known_elsewhere);
  for (const auto& [name, value] : from_command_line_) {
    try {
      set(name, value, "command line");
    } catch (const UsageError& error) {
      throw UsageError("--" + name + " " + value + ": " + error.what());
    }
  }
}

void OptionTable::apply_file(const std::vector<std::string>& known_elsewhere, const std::string& named_by) {
  if (config_file_.empty()) return;
  const json document = read_json(config_file_, named_by);
  for (const auto& [key, value] : document.items()) {
    const std::string name = with_dashes(key);
    if (find(name) == nullptr) {
      if (contains(known_elsewhere, name)) continue;
      throw UsageError(config_file_ + ": unknown key '" + key + "'; the keys are the long options of --help");
    }
    try {
      set(name, text_of(value), config_file_);
    } catch (const UsageError& error) {
      throw UsageError(config_file_ + ": " + key + " = " + value.dump() + ": " + error.what());
    }
  }
}

void OptionTable::apply_environment(const std::vector<std::string>& known_elsewhere) {
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string variable = *entry;
    const std::size_t equals = variable.find('=');
    if (!variable.starts_with("FLOGMAP_") || equals == std::string::npos) continue;
    const std::string key = variable.substr(0, equals);
    const std::string name = with_dashes(key.substr(8));
    const std::string value = variable.substr(equals + 1);
    if (find(name) == nullptr) {
      if (name == "config" || contains(kOtherVariables, name) || contains(known_elsewhere, name)) continue;
      throw UsageError("environment: unknown variable " + key +
                       "; FLOGMAP_ is followed by the name of a long option of --help");
    }
    try {
      set(name, value, "environment");
    } catch (const UsageError& error) {
      throw UsageError("environment: " + key + "=" + value + ": " + error.what());
    }
  }
}

void OptionTable::set(const std::string& name, const std::string& value, const std::string& origin) {
  Option* option = find(name);
  if (option == nullptr) throw UsageError("there is no option '" + name + "'");
  option->parse(value);
  option->origin = origin;
}

Option* OptionTable::find(const std::string& name) {
  const auto found = std::find_if(options_.begin(), options_.end(),
                                  [&](const Option& option) { return option.name == name; });
  return found == options_.end() ? nullptr : &*found;
}

bool OptionTable::is_default(const std::string& name) const {
  return std::any_of(options_.begin(), options_.end(),
                     [&](const Option& option) { return option.name == name && option.origin == "default"; });
}

std::vector<std::string> OptionTable::names() const {
  std::vector<std::string> names;
  for (const Option& option : options_) names.push_back(option.name);
  return names;
}

json OptionTable::effective() const {
  json document = json::object();
  for (const Option& option : options_) {
    const std::string shown = option.show();
    document[option.name] = {{"value", option.secret && !shown.empty() ? "***" : shown},
                             {"origin", option.origin}};
  }
  return document;
}

}  // namespace flogmap
