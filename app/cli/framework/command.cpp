#include "app/cli/framework/command.h"

#include <algorithm>
#include <cmath>

#include "app/cli/framework/suggestion.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina::cli {

namespace {

double numberIn(const std::string& text) {
  const std::optional<double> value = parseNumber(text);
  if (!value || !std::isfinite(*value)) throw Error("'" + text + "' is not a number");
  return *value;
}

std::vector<std::filesystem::path> itself(const std::string& text) {
  return {text};
}

} // namespace

const Command& commandNamed(const std::vector<Command>& commands, const std::string& name) {
  std::vector<std::string> known;
  for (const Command& command : commands) {
    if (command.name == name) return command;
    known.push_back(command.name);
  }
  const bool option = name.starts_with("-");
  throw Error("unknown " + (option ? "option " + name : "command '" + name + "'") +
              suggestion(name, known, "; see patina --help"));
}

const Keys& commonKeys() {
  static const Keys keys = {
      {"program",
       "",
       "program that made the report",
       "",
       Shown::never,
       {{"version", "", ""}, {"commit", "", ""}}},
      {"inputs",
       "",
       "files that the command line names, as they were before",
       "",
       Shown::never,
       {{"path", "", ""}, {"sha256", "", ""}, {"digest", "", "", "of a folder of pictures"}}}};
  return keys;
}

std::vector<Argument> commonArguments(const Command& command) {
  const Setter seen = [](const std::string&) {}; // the parser handles these options itself
  std::vector<Argument> all = {{"-h,--help", "", "", "", "Print this help.", seen}};
  if (std::ranges::any_of(command.arguments, &Argument::is_output))
    all.insert(all.begin(), {"--no-clobber", "", "", "", "Never overwrite existing files.", seen});
  if (command.changes_workspace)
    all.insert(all.begin(),
               {"--intent", "ID", "", "",
                "Do nothing if a command with this ID has changed the workspace already.", seen});
  if (!command.keys.empty())
    all.insert(all.begin(),
               {"--json", "", "", "", "Print the report as one JSON object on stdout.", seen});
  return all;
}

Setter into(std::filesystem::path& target) {
  return {[&target](const std::string& text) { target = text; }, itself};
}

Setter into(std::vector<std::filesystem::path>& list) {
  return {[&list](const std::string& text) { list.emplace_back(text); }, itself};
}

Setter outInto(std::filesystem::path& target) {
  return [&target](const std::string& text) { target = text; };
}

Setter into(bool& flag) {
  return [&flag](const std::string&) { flag = true; };
}

Setter into(std::vector<std::string>& list, FilesIn files) {
  return {[&list](const std::string& text) { list.push_back(text); }, std::move(files)};
}

Setter into(std::optional<double>& number) {
  return parsedInto(number, numberIn);
}

Setter inRange(double lowest, double highest, std::function<void(double)> set, NumberKind kind) {
  return [=](const std::string& text) {
    const double value = kind == NumberKind::length ? parseLength(text) : numberIn(text);
    const bool fits = value >= lowest && value <= highest;
    if (kind == NumberKind::whole && (!fits || value != std::floor(value)))
      throw Error("'" + text + "' is not a whole number from " + formatNumber(lowest) + " to " +
                  formatNumber(highest));
    if (!fits)
      throw Error("'" + text + "': it must be between " + formatNumber(lowest) + " and " +
                  formatNumber(highest));
    set(value);
  };
}

Argument input(const std::string& name, const std::string& caption, Setter set, Times times) {
  return {name, name, "", "", caption, std::move(set), times};
}

Argument sceneInput(std::filesystem::path& target, const std::string& name) {
  return input(name, "Mesh (.obj .ply .stl), workspace or volume (.vti).", into(target));
}

Argument outputTo(std::filesystem::path& target, const std::string& value,
                  const std::string& caption) {
  return {"-o,--output", value, "", "", caption, outInto(target), Times::once, true};
}

Argument writtenTo(std::filesystem::path& target, const std::string& names,
                   const std::string& value, const std::string& caption) {
  return {names, value, "", "", caption, outInto(target), Times::at_most_once, true};
}

Vec3 parsePoint(const std::string& text) {
  Vec3 point;
  std::size_t begin = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t end = axis < 2 ? text.find(',', begin) : text.size();
    if (end == std::string::npos) throw Error("'" + text + "' is not X,Y,Z");
    point[axis] = parseLength(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return point;
}

} // namespace patina::cli
