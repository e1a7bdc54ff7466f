#include "app/cli/output/completion.h"
#include "app/cli/commands/commands.h"
#include "core/error.h"

namespace patina::cli {

Command completionCommand() {
  auto shell = std::make_shared<std::string>();
  return {.name = "completion",
          .summary = "print what makes a shell complete commands and options",
          .description = "SHELL is bash or zsh. The script knows commands, options and the words "
                         "that an option may have, from the same table as --help.",
          .examples = {"patina completion bash > ~/.local/share/bash-completion/completions/patina",
                       "patina completion zsh > ~/.zfunc/_patina"},
          .keys = {},
          .arguments = {input("SHELL", "bash or zsh.",
                              [shell](const std::string& word) {
                                if (word != "bash" && word != "zsh")
                                  throw Error("unknown shell '" + word + "': bash or zsh");
                                *shell = word;
                              })},
          .run = [shell](Console& console) {
            const std::vector<Command> commands = allCommands();
            console.print(*shell == "bash" ? bashCompletion(commands) : zshCompletion(commands));
            return kDone;
          }};
}

} // namespace patina::cli
