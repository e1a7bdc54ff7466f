#include "app/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <sstream>

#include "app/cli/commands/commands.h"
#include "app/cli/output/help.h"
#include "core/error.h"

namespace patina::cli {

namespace {

void addArgument(CLI::App& parser, const Argument& argument) {
  const auto set = [&argument](const std::string& text) {
    try {
      argument.set(text);
    } catch (const FileError&) {
      throw;
    } catch (const Error& error) {
      throw Error(argument.names.substr(argument.names.rfind(',') + 1) + ": " + error.what());
    }
  };
  if (!argument.positional() && argument.value.empty()) {
    parser.add_flag_callback(argument.names, [set] { set(""); });
    return;
  }
  // A positional is shown by its name, which need not be a word that the parser accepts.
  const std::string names = argument.positional() ? "input" : argument.names;
  CLI::Option* option = parser.add_option_function<std::vector<std::string>>(
      names, [set](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) set(text);
      });
  // Else an option's list of values goes on over the input that follows it.
  if (!argument.positional()) option->allow_extra_args(false);
  if (argument.positional() && argument.repeated)
    option->expected(-1);
  else if (argument.positional())
    option->expected(1);
  else if (argument.repeated)
    option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  else
    option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

// What the parser cannot say in our words: an option that does not exist, a word too many. `words`
// follow the command's name.
void requireKnown(const Command& command, const std::vector<std::string>& words) {
  const std::string see = "; see patina " + command.name + " --help";
  const Argument* input = nullptr;
  std::map<std::string, bool> takes_value = {
      {"-h", false}, {"--help", false}, {"--version", false}};
  if (command.reports) takes_value["--json"] = false;
  for (const Argument& argument : command.arguments) {
    if (argument.positional()) input = &argument;
    std::istringstream names(argument.positional() ? "" : argument.names);
    for (std::string name; std::getline(names, name, ',');)
      takes_value[name] = !argument.value.empty();
  }
  std::size_t inputs = 0;
  bool only_inputs = false; // after "--"
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (!only_inputs && word == "--") {
      only_inputs = true;
    } else if (only_inputs || word.size() < 2 || word[0] != '-') {
      if (++inputs > 1 && input && !input->repeated)
        throw Error(command.name + ": one " + input->value + " at a time: '" + word +
                    "' is one too many" + see);
      if (!input) throw Error(command.name + ": '" + word + "' is one word too many" + see);
    } else {
      // "--name=value" and "-ovalue" carry their value with them.
      const bool is_long = word[1] == '-';
      const std::string name = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
      const auto known = takes_value.find(name);
      if (known == takes_value.end()) throw Error("unknown option " + name + see);
      if (known->second && name == word) ++i;
    }
  }
}

// What the parser cannot say in our words: a required argument that is missing.
void requireAll(const Command& command, const CLI::App& parser) {
  for (const Argument& argument : command.arguments) {
    const std::string& names = argument.names;
    const std::string name = argument.positional() ? "input" : names.substr(names.rfind(',') + 1);
    if (argument.required && parser.count(name) == 0)
      throw Error(command.name + ": " + (argument.positional() ? argument.value : name) +
                  " is missing (see patina " + command.name + " --help)");
  }
}

} // namespace

int runCommandLine(int argc, char** argv) {
  const std::vector<Command> commands = allCommands();
  CLI::App program;
  program.set_help_flag();
  program.require_subcommand(0, 1); // so that "patina study field" is a study, not two commands
  bool help = false;
  bool version = false;
  Console console;
  program.add_flag("-h,--help", help);
  program.add_flag("--version", version);
  std::vector<CLI::App*> parsers;
  for (const Command& command : commands) {
    CLI::App* parser = program.add_subcommand(command.name);
    parser->set_help_flag();
    parser->add_flag("-h,--help", help);
    parser->add_flag("--version", version);
    if (command.reports) parser->add_flag("--json", console.json);
    for (const Argument& argument : command.arguments) addArgument(*parser, argument);
    parsers.push_back(parser);
  }

  // Asking for help must work however incomplete or wrong the rest of the line is.
  for (int i = 1; i < argc; ++i) help = help || std::string(argv[i]) == "--help";
  if (!help) {
    for (const Command& command : commands)
      if (argc > 1 && command.name == argv[1]) requireKnown(command, {argv + 2, argv + argc});
    try {
      program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      throw Error(std::string(error.what()) + " (see patina --help)");
    }
  }
  if (version) {
    std::puts("patina " PATINA_VERSION);
    return kDone;
  }
  if (help) {
    for (const Command& command : commands)
      if (argc > 1 && command.name == argv[1]) {
        std::fputs(commandHelp(command).c_str(), stdout);
        return kDone;
      }
    std::fputs(programHelp(commands).c_str(), stdout);
    return kDone;
  }
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!parsers[i]->parsed()) continue;
    requireAll(commands[i], *parsers[i]);
    return commands[i].run(console);
  }
  throw Error("which command? See patina --help");
}

} // namespace patina::cli
