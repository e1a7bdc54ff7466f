#include "app/cli/command_line.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <iterator>
#include <map>
#include <sstream>

#include "app/cli/commands/commands.h"
#include "app/cli/framework/former_options.h"
#include "app/cli/framework/suggestion.h"
#include "app/cli/input/input_files.h"
#include "app/cli/output/help.h"
#include "core/error.h"
#include "core/output_target.h"
#include "core/version.h"

namespace patina::cli {

namespace {

using Words = std::vector<std::string>;

// Returns the input for the next word: the first that accepts another value, else the last.
const Argument* nextInput(const Command& command, const std::map<std::string, Words>& given) {
  const Argument* last = nullptr;
  for (const Argument& argument : command.arguments) {
    if (!argument.isInput()) continue;
    last = &argument;
    if (argument.isRepeated() || !given.contains(argument.name())) break;
  }
  return last;
}

Words namesOf(const Argument& argument) {
  std::istringstream names(argument.names);
  Words words;
  for (std::string name; std::getline(names, name, ',');) words.push_back(name);
  return words;
}

// Returns the option with that name; throws Error if the command has none.
const Argument& optionNamed(const Command& command, const std::string& name) {
  Words known;
  for (const Argument& argument : command.arguments) {
    if (argument.isInput()) continue;
    for (const std::string& each : namesOf(argument)) {
      if (each == name) return argument;
      known.push_back(each);
    }
  }
  throw Error("unknown option " + name +
              suggestion(name, known, "; see patina " + command.name + " --help"));
}

void give(const Argument& argument, const std::string& value) {
  try {
    argument.set(value);
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    if (argument.isInput()) throw;
    throw Error(argument.name() + ": " + error.what());
  }
}

using Given = std::map<std::string, Words>;

// A shell passes "" for a variable that is not set.
void requireSome(const Argument& argument, const std::string& word, const std::string& see) {
  if (word.empty()) throw Error(argument.name() + ": '' is no value; see " + see);
}

Given parse(const Command& command, const Words& words) {
  const std::string see = "patina " + command.name + " --help";
  Given given;
  bool only_inputs = false; // set by "--"
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (!only_inputs && word == "--") {
      only_inputs = true;
      continue;
    }
    if (only_inputs || word.size() < 2 || word[0] != '-') {
      const Argument* input = nextInput(command, given);
      if (!input) throw Error(command.name + ": '" + word + "' is one word too many; see " + see);
      if (given.contains(input->name()) && !input->isRepeated())
        throw Error(command.name + ": one " + input->value + " at a time: '" + word +
                    "' is one too many; see " + see);
      requireSome(*input, word, see);
      given[input->name()].push_back(word);
      give(*input, word);
      continue;
    }
    // "--name=value" and "-ovalue" contain the value.
    const bool is_long = word[1] == '-';
    const std::size_t end = is_long ? word.find('=') : 2;
    const std::string name = word.substr(0, end);
    const bool carries = end < word.size();
    const Argument& option = optionNamed(command, name);
    Words& values = given[option.name()];
    if (option.isFlag() && carries) throw Error(name + " takes no value; see " + see);
    if (!option.isFlag() && !carries && i + 1 == words.size())
      throw Error(name + ": " + option.value + " is missing after it; see " + see);
    values.push_back(option.isFlag() ? ""
                     : carries       ? word.substr(end + (is_long ? 1 : 0))
                                     : words[++i]);
    if (!option.isFlag()) requireSome(option, values.back(), see);
    give(option, values.back());
  }
  for (const Argument& argument : command.arguments)
    if (argument.isRequired() && !given.contains(argument.name()))
      throw Error(command.name + ": " + argument.name() + " is missing (see " + see + ")");
  return given;
}

// Checks input and output files, and warns of options given more often than they count.
void checkFiles(const Command& command, const Given& given, Console& console) {
  std::size_t read = 0, written = 0;
  for (const Argument& argument : command.arguments) {
    const auto found = given.find(argument.name());
    if (found == given.end()) continue;
    const Words& values = found->second;
    if (values.size() > 1 && !argument.isRepeated() && !argument.isFlag())
      console.warn(argument.name() + " is given " + std::to_string(values.size()) +
                   " times: only the last counts");
    const auto streams = std::ranges::count_if(values, isStandardStream);
    (argument.is_output ? written : read) += static_cast<std::size_t>(streams);
    if (!argument.is_output) continue;
    const std::filesystem::path path = values.back();
    const bool stream = isStandardStream(path) || path == "/dev/stdout";
    console.data_on_stdout |= stream;
    if (stream || !given.contains("--no-clobber") || !pathExists(path)) continue;
    const bool empty_folder =
        std::filesystem::is_directory(path) && std::filesystem::is_empty(path);
    if (!empty_folder) throw FileError(path.string(), 0, "exists, and --no-clobber keeps it");
  }
  if (read > 1)
    throw Error("'-' is given " + std::to_string(read) + " times: standard input is one");
  if (written > 1)
    throw Error("'-' is given " + std::to_string(written) + " times: standard output is one");
}

std::vector<std::filesystem::path> filesRead(const Command& command, const Given& given) {
  std::vector<std::filesystem::path> files;
  for (const Argument& argument : command.arguments) {
    const auto found = given.find(argument.name());
    if (found == given.end()) continue;
    // only the last counts, unless the argument may be repeated
    const Words& values = found->second;
    for (auto value = argument.isRepeated() ? values.begin() : values.end() - 1;
         value != values.end(); ++value)
      std::ranges::copy(argument.set.filesIn(*value), std::back_inserter(files));
  }
  return files;
}

// It becomes part of a journal's record and of messages.
std::string requireIntent(const std::string& word) {
  const bool plain =
      word.size() <= 100 && std::ranges::all_of(word, [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
      });
  if (!plain)
    throw Error("--intent: '" + word + "': use letters, digits, '-', '_' and '.', up to 100");
  return word;
}

int run(const Words& words, Console& console) {
  const std::vector<Command> commands = allCommands();
  const auto only_inputs = std::ranges::find(words, "--");
  const auto asked = [&](const char* name) {
    return std::find(words.begin(), only_inputs, name) != only_inputs;
  };
  // Help must work even if the rest of the line is incomplete or wrong.
  if (asked("--help") || asked("-h")) {
    const auto about = std::ranges::find(commands, words.front(), &Command::name);
    console.print(about == commands.end() ? programHelp(commands) : commandHelp(*about));
    return kDone;
  }
  if (asked("--version") || words == Words{"-V"}) {
    console.print("patina " + versionText() + "\n");
    return kDone;
  }
  console.json = asked("--json");
  if (words.empty()) throw Error("which command? See patina --help");
  Command command = commandNamed(commands, words.front());
  for (const Argument& argument : commonArguments(command)) command.arguments.push_back(argument);
  const Given given = parse(command, {words.begin() + 1, words.end()});
  checkFiles(command, given, console);
  for (const auto& [name, values] : given) console.given.insert(name);
  if (given.contains("--intent")) console.intent = requireIntent(given.at("--intent").back());
  // Before the command runs, because it may change its inputs.
  if (console.json || given.contains("--report"))
    console.inputs = describeInputs(filesRead(command, given));
  return command.run(console);
}

} // namespace

int runCommandLine(int argc, char** argv) {
  try {
    Console console;
    try {
      return console.finish(run(inPresentSpelling(Words(argv + 1, argv + argc)), console));
    } catch (const std::exception& error) {
      return console.finish(console.fail(error));
    }
  } catch (const std::exception& error) { // not enough memory even for the message
    std::fprintf(stderr, "patina: %s\n", error.what());
    return kBadInput;
  }
}

} // namespace patina::cli
