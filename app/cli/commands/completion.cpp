#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "app/cli/commands/commands.h"
#include "app/cli/framework/command.h"
#include "core/error.h"

namespace patina::cli {
namespace {

// Scripts for shell completion, generated from the commands.

using Words = std::vector<std::string>;

Words split(const std::string& text, char separator) {
  std::istringstream in(text);
  Words words;
  for (std::string word; std::getline(in, word, separator);) words.push_back(word);
  return words;
}

std::vector<Argument> argumentsOf(const Command& command) {
  std::vector<Argument> all = command.arguments;
  for (Argument& argument : commonArguments(command)) all.push_back(std::move(argument));
  return all;
}

// Allowed words of an option, from "mm|cm|m"; empty if any value is allowed.
Words choices(const Argument& argument) {
  const Words words = split(argument.value, '|');
  return words.size() > 1 ? words : Words();
}

// Keeps only characters without a meaning in any shell.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) out += std::string("'\\[]:\"`$").find(c) == std::string::npos ? c : ' ';
  return out;
}

// Escapes for single quotes and the brackets of zsh's _arguments.
std::string quoted(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else
      out += c == '[' ? '(' : c == ']' ? ')' : c == '\\' ? ' ' : c;
  }
  return out;
}

// Escapes for single quotes of fish, in which only quotes and backslashes need it.
std::string fishQuoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

// Script to be sourced, or installed for bash-completion.
std::string bashCompletion(const std::vector<Command>& commands) {
  std::string names, cases, words_of;
  for (const Command& command : commands) {
    names += (names.empty() ? "" : " ") + command.name;
    std::string options;
    for (const Argument& argument : argumentsOf(command)) {
      if (argument.isInput()) continue;
      for (const std::string& name : split(argument.names, ',')) {
        options += (options.empty() ? "" : " ") + name;
        if (const Words words = choices(argument); !words.empty())
          words_of +=
              "    " + command.name + " " + name + ") words='" + joined(words, " ") + "' ;;\n";
      }
    }
    cases += "    " + command.name + ") options='" + options + "' ;;\n";
  }
  // Case patterns with a space are quoted.
  std::string patterns;
  for (const std::string& line : split(words_of, '\n')) {
    const std::size_t end = line.find(')');
    patterns += "    '" + line.substr(4, end - 4) + "'" + line.substr(end) + "\n";
  }
  return "# bash completion of patina; made by: patina completion bash\n"
         "_patina() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
         "  local command=${COMP_WORDS[1]} options='' words=''\n"
         "  COMPREPLY=()\n"
         "  if [[ $COMP_CWORD -eq 1 || ($COMP_CWORD -eq 2 && $command = @(help|man) && $word != "
         "-*) "
         "]]; then\n"
         "    COMPREPLY=($(compgen -W '" +
         names +
         " --help --version' -- \"$word\"))\n"
         "    return\n"
         "  fi\n"
         "  case \"$command $before\" in\n" +
         patterns +
         "  esac\n"
         "  if [ -n \"$words\" ]; then\n"
         "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
         "    return\n"
         "  fi\n"
         "  case $command in\n" +
         cases +
         "  esac\n"
         "  case $word in\n"
         "    -*) COMPREPLY=($(compgen -W \"$options\" -- \"$word\")) ;;\n"
         "    *) COMPREPLY=($(compgen -f -- \"$word\")) ;;\n"
         "  esac\n"
         "}\n"
         "complete -o filenames -F _patina patina\n";
}

// Script to be installed as _patina in a folder of zsh's fpath.
std::string zshCompletion(const std::vector<Command>& commands) {
  std::string list, cases;
  for (const Command& command : commands) {
    list += "    '" + command.name + ":" + quoted(command.summary) + "'\n";
    cases += "    " + command.name + ")\n      _arguments -s";
    for (const Argument& argument : argumentsOf(command)) {
      if (argument.isInput()) continue;
      const Words words = choices(argument);
      const std::string value = argument.isFlag() ? ""
                                : words.empty()
                                    ? ":" + plain(argument.value) + ":_files"
                                    : ":" + plain(argument.value) + ":(" + joined(words, " ") + ")";
      for (const std::string& name : split(argument.names, ','))
        cases += " \\\n        '" + std::string(argument.isRepeated() ? "*" : "") + name + "[" +
                 quoted(argument.caption) + "]" + value + "'";
    }
    cases += " \\\n        '*:file:_files'\n      ;;\n";
  }
  return "#compdef patina\n# zsh completion of patina; made by: patina completion zsh\n"
         "local -a commands\n"
         "if (( CURRENT == 2 )) ||\n"
         "   [[ $CURRENT == 3 && $words[2] == (help|man) && $words[3] != -* ]]; then\n"
         "  commands=(\n" +
         list +
         "  )\n"
         "  _describe command commands\n"
         "  return\n"
         "fi\n"
         "local command=$words[2]\n"
         "shift words\n"
         "(( CURRENT -= 1 ))\n"
         "case $command in\n" +
         cases + "esac\n";
}

// Script to be installed as patina.fish in a folder of fish's completions.
std::string fishCompletion(const std::vector<Command>& commands) {
  std::string names, options;
  for (const Command& command : commands) {
    names += "complete -c patina -n '__patina_command_is \"\" help man' -f -a " + command.name +
             " -d " + fishQuoted(command.summary) + "\n";
    for (const Argument& argument : argumentsOf(command)) {
      if (argument.isInput()) continue;
      options += "complete -c patina -n '__patina_command_is " + command.name + "'";
      for (const std::string& name : split(argument.names, ','))
        options += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (const Words words = choices(argument); !words.empty())
        options += " -x -a " + fishQuoted(joined(words, " "));
      else if (!argument.isFlag())
        options += " -r";
      options += " -d " + fishQuoted(argument.caption) + "\n";
    }
  }
  return "# fish completion of patina; made by: patina completion fish\n"
         "# Succeeds if the word after patina is one of the arguments; \"\" stands for no word "
         "yet.\n"
         "function __patina_command_is\n"
         "  set -l words (commandline -opc) \"\"\n"
         "  contains -- $words[2] $argv\n"
         "end\n" +
         names + options;
}

} // namespace

Command completionCommand() {
  auto shell = std::make_shared<std::string>();
  return {.name = "completion",
          .summary = "print a script for shell completion",
          .description = "SHELL is bash, zsh or fish. The script contains commands, options and "
                         "the words that an option may have, from the same table as --help.",
          .examples = {"patina completion bash > ~/.local/share/bash-completion/completions/patina",
                       "patina completion zsh > ~/.zfunc/_patina",
                       "patina completion fish > ~/.config/fish/completions/patina.fish"},
          .keys = {},
          .arguments = {input("SHELL", "bash, zsh or fish.",
                              [shell](const std::string& word) {
                                if (word != "bash" && word != "zsh" && word != "fish")
                                  throw Error("unknown shell '" + word + "': bash, zsh or fish");
                                *shell = word;
                              })},
          .run = [shell](Console& console) {
            const std::vector<Command> commands = allCommands();
            console.print(*shell == "bash"  ? bashCompletion(commands)
                          : *shell == "zsh" ? zshCompletion(commands)
                                            : fishCompletion(commands));
            return kDone;
          }};
}

} // namespace patina::cli
