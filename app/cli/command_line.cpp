#include "app/cli/command_line.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <sstream>

#include "app/cli/commands/commands.h"
#include "app/cli/input/suggestion.h"
#include "app/cli/output/help.h"
#include "core/error.h"

namespace patina::cli {

namespace {

using Words = std::vector<std::string>;

// The input that the next word is for: the first that may still be given, else the last.
const Argument* nextInput(const Command& command, const std::set<std::string>& given) {
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

// The option of that name; Error if the command has none.
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

// Fills in the command's options from the words after its name; which were given, by name.
std::set<std::string> parse(const Command& command, const Words& words) {
  const std::string see = "patina " + command.name + " --help";
  std::set<std::string> given;
  bool only_inputs = false; // after "--"
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (!only_inputs && word == "--") {
      only_inputs = true;
      continue;
    }
    if (only_inputs || word.size() < 2 || word[0] != '-') {
      const Argument* input = nextInput(command, given);
      if (!input) throw Error(command.name + ": '" + word + "' is one word too many; see " + see);
      if (!given.insert(input->name()).second && !input->isRepeated())
        throw Error(command.name + ": one " + input->value + " at a time: '" + word +
                    "' is one too many; see " + see);
      give(*input, word);
      continue;
    }
    // "--name=value" and "-ovalue" carry their value with them.
    const bool is_long = word[1] == '-';
    const std::size_t end = is_long ? word.find('=') : 2;
    const std::string name = word.substr(0, end);
    const bool carries = end < word.size();
    const Argument& option = optionNamed(command, name);
    given.insert(option.name());
    if (option.isFlag() && carries) throw Error(name + " takes no value; see " + see);
    if (!option.isFlag() && !carries && i + 1 == words.size())
      throw Error(name + ": " + option.value + " is missing after it; see " + see);
    if (option.isFlag())
      give(option, "");
    else
      give(option, carries ? word.substr(end + (is_long ? 1 : 0)) : words[++i]);
  }
  for (const Argument& argument : command.arguments)
    if (argument.isRequired() && !given.contains(argument.name()))
      throw Error(command.name + ": " + argument.name() + " is missing (see " + see + ")");
  return given;
}

const Command& commandNamed(const std::vector<Command>& commands, const std::string& name) {
  Words known;
  for (const Command& command : commands) {
    if (command.name == name) return command;
    known.push_back(command.name);
  }
  const bool option = name.starts_with("-");
  throw Error("unknown " + (option ? "option " + name : "command '" + name + "'") +
              suggestion(name, known, "; see patina --help"));
}

} // namespace

int runCommandLine(int argc, char** argv) {
  const std::vector<Command> commands = allCommands();
  const Words words(argv + 1, argv + argc);
  const auto only_inputs = std::ranges::find(words, "--");
  const auto asked = [&](const char* name) {
    return std::find(words.begin(), only_inputs, name) != only_inputs;
  };
  // Asking for help must work however incomplete or wrong the rest of the line is.
  if (asked("--help") || asked("-h")) {
    const auto about = std::ranges::find(commands, words.front(), &Command::name);
    std::fputs((about == commands.end() ? programHelp(commands) : commandHelp(*about)).c_str(),
               stdout);
    return kDone;
  }
  if (asked("--version")) {
    std::puts("patina " PATINA_VERSION);
    return kDone;
  }
  if (words.empty()) throw Error("which command? See patina --help");
  Console console;
  Command command = commandNamed(commands, words.front());
  for (const Argument& argument : commonArguments(command)) command.arguments.push_back(argument);
  console.json = parse(command, {words.begin() + 1, words.end()}).contains("--json");
  return command.run(console);
}

} // namespace patina::cli
