#include "app/cli/output/help.h"
#include "app/cli/commands/commands.h"

namespace patina::cli {

Command helpCommand() {
  auto name = std::make_shared<std::string>();
  return {.name = "help",
          .summary = "print the help of a command",
          .description = "What patina COMMAND --help prints; without COMMAND the list of commands.",
          .examples = {"patina help feel"},
          .keys = {},
          .arguments = {input(
              "COMMAND", "Which.", [name](const std::string& word) { *name = word; },
              Times::at_most_once)},
          .run = [name](Console& console) {
            const std::vector<Command> commands = allCommands();
            console.print(name->empty() ? programHelp(commands)
                                        : commandHelp(commandNamed(commands, *name)));
            return kDone;
          }};
}

} // namespace patina::cli
