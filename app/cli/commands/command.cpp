#include "app/cli/commands/command.h"

#include <climits>
#include <cmath>

#include "core/error.h"
#include "core/numbers.h"

namespace patina::cli {

namespace {

double numberIn(const std::string& text) {
  const std::optional<double> value = parseNumber(text);
  if (!value || !std::isfinite(*value)) throw Error("'" + text + "' is not a number");
  return *value;
}

} // namespace

Argument& Command::input(const std::string& argument, const std::string& help,
                         std::filesystem::path& target) {
  arguments.push_back(
      {argument, argument, help, "", true, false, [&target](const auto& text) { target = text; }});
  return arguments.back();
}

Argument& Command::output(const std::string& value, const std::string& help,
                          std::filesystem::path& target) {
  Argument& argument = file("-o,--output", value, help, target);
  argument.required = true;
  return argument;
}

Argument& Command::file(const std::string& names, const std::string& value, const std::string& help,
                        std::filesystem::path& target) {
  arguments.push_back(
      {names, value, help, "", false, false, [&target](const auto& text) { target = text; }});
  return arguments.back();
}

Argument& Command::text(const std::string& names, const std::string& value, const std::string& help,
                        std::string& target) {
  arguments.push_back(
      {names, value, help, target, false, false, [&target](const auto& text) { target = text; }});
  return arguments.back();
}

Argument& Command::number(const std::string& names, const std::string& value,
                          const std::string& help, std::optional<double>& target) {
  arguments.push_back({names, value, help, target ? formatNumber(*target) : "", false, false,
                       [&target](const auto& text) { target = numberIn(text); }});
  return arguments.back();
}

Argument& Command::length(const std::string& names, const std::string& help,
                          std::optional<double>& target) {
  arguments.push_back({names, "LENGTH", help, target ? formatLength(*target) : "", false, false,
                       [&target](const auto& text) { target = parseLength(text); }});
  return arguments.back();
}

Argument& Command::integer(const std::string& names, const std::string& help, int& target,
                           int lowest) {
  arguments.push_back({names, "N", help, std::to_string(target), false, false,
                       [&target, lowest](const std::string& text) {
                         const double value = numberIn(text);
                         if (value != std::floor(value) || value < lowest || value > INT_MAX)
                           throw Error("'" + text + "' is not a whole number of " +
                                       std::to_string(lowest) + " or more");
                         target = static_cast<int>(value);
                       }});
  return arguments.back();
}

Argument& Command::flag(const std::string& names, const std::string& help, bool& target) {
  arguments.push_back(
      {names, "", help, "", false, false, [&target](const auto&) { target = true; }});
  return arguments.back();
}

} // namespace patina::cli
