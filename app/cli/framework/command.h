// One command as data, from which the parser, --help and the man page are made.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "app/cli/framework/console.h"
#include "core/types.h"

namespace patina::cli {

// Returns the files and folders that an argument's text names.
using FilesIn = std::function<std::vector<std::filesystem::path>(const std::string&)>;

// Stores an argument's value; throws Error if it is invalid.
class Setter {
 public:
  template <typename Set>
  Setter(Set set, FilesIn files = nullptr) : set_(std::move(set)), files_(std::move(files)) {}
  void operator()(const std::string& text) const { set_(text); }
  std::vector<std::filesystem::path> filesIn(const std::string& text) const {
    return files_ ? files_(text) : std::vector<std::filesystem::path>();
  }

 private:
  std::function<void(const std::string&)> set_;
  FilesIn files_; // null: the value is a word or a number
};

// Number of times that an argument may be given.
enum class Times { at_most_once, once, any, at_least_once };

struct Argument {
  std::string names;    // "-o,--output", or "MESH" for an input
  std::string value;    // placeholder: "FILE", "LENGTH"; empty for a flag
  std::string unit;     // unit of the value: "N/m"
  std::string fallback; // default as text; empty if there is none
  std::string caption;
  Setter set;
  Times times = Times::at_most_once;
  bool is_output = false; // the value names a file or folder that is written

  bool isInput() const { return names.front() != '-'; }
  bool isFlag() const { return value.empty(); }
  bool isRequired() const { return times == Times::once || times == Times::at_least_once; }
  bool isRepeated() const { return times == Times::any || times == Times::at_least_once; }
  // Name in messages.
  std::string name() const { return names.substr(names.rfind(',') + 1); }
};

struct Command {
  std::string name;
  std::string summary;     // one line
  std::string description; // paragraphs separated by '\n'
  std::vector<std::string> examples;
  Keys keys; // keys of its report; empty: no --json
  std::vector<Argument> arguments;
  std::function<int(Console&)> run; // returns an exit code
  bool changes_workspace = false;   // adds --intent
};

// Throws Error for an unknown name and suggests a similar one.
const Command& commandNamed(const std::vector<Command>& commands, const std::string& name);

// Keys of every command's report besides its own.
const Keys& commonKeys();
// Options of every command: --json if it has keys, --no-clobber if it writes, --intent if it
// changes a workspace, and --help.
std::vector<Argument> commonArguments(const Command& command);

// Targets must outlive the parse.
Setter into(std::filesystem::path& target);            // a file or folder to read
Setter into(std::vector<std::filesystem::path>& list); // several files or folders to read
Setter outInto(std::filesystem::path& target);         // a file or folder that is only written
Setter into(bool& flag);                               // true
Setter into(std::vector<std::string>& list, FilesIn files = nullptr);
Setter into(std::optional<double>& number);
// Range with its ends; a length may have a unit.
enum class NumberKind { plain, whole, length };
Setter inRange(double lowest, double highest, std::function<void(double)> set,
               NumberKind kind = NumberKind::plain);
// The same into a number, or an optional one.
template <typename Value>
Setter numberInto(double lowest, double highest, Value& target,
                  NumberKind kind = NumberKind::plain) {
  const auto set = [&target](double value) {
    if constexpr (std::is_arithmetic_v<Value>)
      target = static_cast<Value>(value);
    else
      target = static_cast<typename Value::value_type>(value);
  };
  return inRange(lowest, highest, set, kind);
}
// X,Y,Z; lengths may carry their unit. Throws Error.
Vec3 parsePoint(const std::string& text);
template <typename Value, typename Parse> Setter parsedInto(Value& target, Parse parse) {
  return [&target, parse](const std::string& text) { target = parse(text); };
}

Argument input(const std::string& name, const std::string& caption, Setter set,
               Times times = Times::once);
Argument sceneInput(std::filesystem::path& target, const std::string& name = "INPUT");
Argument outputTo(std::filesystem::path& target, const std::string& value,
                  const std::string& caption);
// The same, optional.
Argument writtenTo(std::filesystem::path& target, const std::string& names,
                   const std::string& value, const std::string& caption);

} // namespace patina::cli
