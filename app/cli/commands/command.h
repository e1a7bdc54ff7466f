// One command as data: the parser, --help and the man page are all made from it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/output/console.h"
#include "core/types.h"

namespace patina::cli {

// The files and folders that the text of an argument names.
using FilesIn = std::function<std::vector<std::filesystem::path>(const std::string&)>;

// Takes over an argument's value; throws Error on a bad one.
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

// How often an argument is given.
enum class Times { at_most_once, once, any, at_least_once };

struct Argument {
  std::string names;    // "-o,--output", or "MESH" for an input
  std::string value;    // what stands after it: "FILE", "LENGTH"; empty for a flag
  std::string unit;     // of the value: "N/m"
  std::string fallback; // the default as text; empty if there is none
  std::string caption;
  Setter set;
  Times times = Times::at_most_once;
  bool is_output = false; // the value names a file or folder that is written

  bool isInput() const { return names.front() != '-'; }
  bool isFlag() const { return value.empty(); }
  bool isRequired() const { return times == Times::once || times == Times::at_least_once; }
  bool isRepeated() const { return times == Times::any || times == Times::at_least_once; }
  // How messages call it.
  std::string name() const { return names.substr(names.rfind(',') + 1); }
};

struct Command {
  std::string name;
  std::string summary;     // one line
  std::string description; // paragraphs separated by '\n'
  std::vector<std::string> examples;
  Keys keys; // of its report; empty: it has no --json
  std::vector<Argument> arguments;
  std::function<int(Console&)> run; // returns an exit code
};

// Throws Error for a name that none has, with the one that may be meant.
const Command& commandNamed(const std::vector<Command>& commands, const std::string& name);

// What the report of every command has besides its own keys.
const Keys& commonKeys();
// What every command has: --json where there are keys, --no-clobber where something is written, and
// --help.
std::vector<Argument> commonArguments(const Command& command);

// Targets must outlive the parse.
Setter into(std::filesystem::path& target);            // of a file or folder that is read
Setter into(std::vector<std::filesystem::path>& list); // of several
Setter outInto(std::filesystem::path& target);         // of a file or folder that is only written
Setter into(bool& flag);                               // true
Setter into(std::vector<std::string>& list, FilesIn files = nullptr);
Setter into(std::optional<double>& number);
// In a range, its ends included; a length may carry its unit.
enum class NumberKind { plain, whole, length };
Setter inRange(double lowest, double highest, std::function<void(double)> set,
               NumberKind kind = NumberKind::plain);
// X,Y,Z; lengths may carry their unit. Throws Error.
Vec3 parsePoint(const std::string& text);
// What `parse` makes of the text.
template <typename Value, typename Parse> Setter parsedInto(Value& target, Parse parse) {
  return [&target, parse](const std::string& text) { target = parse(text); };
}

// What a command reads and writes.
Argument input(const std::string& name, const std::string& caption, Setter set,
               Times times = Times::once);
Argument sceneInput(std::filesystem::path& target, const std::string& name = "INPUT");
Argument outputTo(std::filesystem::path& target, const std::string& value,
                  const std::string& caption);
// The same for one that need not be given.
Argument writtenTo(std::filesystem::path& target, const std::string& names,
                   const std::string& value, const std::string& caption);

} // namespace patina::cli
