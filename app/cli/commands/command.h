// One command as data: the parser, --help and the man page are all made from it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/output/console.h"

namespace patina::cli {

enum ExitCode { kDone = 0, kNotSolved = 1, kBadInput = 2, kCancelledByUser = 130 };

struct Argument {
  std::string names;    // "-o,--output", or "MESH" for a positional
  std::string value;    // what stands after it: "FILE", "LENGTH"; empty for a flag
  std::string help;     // with the unit
  std::string fallback; // the default as text; empty if there is none
  bool required = false;
  bool repeated = false;                       // may be given more than once
  std::function<void(const std::string&)> set; // throws Error on a bad value

  bool positional() const { return names.front() != '-'; }
};

struct Command {
  std::string name;
  std::string summary;     // one line
  std::string description; // paragraphs separated by '\n'
  std::vector<std::string> examples;
  bool reports = true; // has --json
  std::vector<Argument> arguments;
  std::function<int(Console&)> run; // returns an exit code

  // Each adds an argument that writes to `target`, which must outlive the parse.
  Argument& input(const std::string& name, const std::string& help, std::filesystem::path& target);
  Argument& output(const std::string& value, const std::string& help,
                   std::filesystem::path& target);
  Argument& file(const std::string& names, const std::string& value, const std::string& help,
                 std::filesystem::path& target);
  Argument& text(const std::string& names, const std::string& value, const std::string& help,
                 std::string& target);
  Argument& number(const std::string& names, const std::string& value, const std::string& help,
                   std::optional<double>& target);
  Argument& length(const std::string& names, const std::string& help,
                   std::optional<double>& target);
  Argument& integer(const std::string& names, const std::string& help, int& target, int lowest);
  Argument& flag(const std::string& names, const std::string& help, bool& target);
};

} // namespace patina::cli
