#include "app/cli/output/completion.h"
#include "app/cli/commands/commands.h"
#include "core/error.h"

namespace patina::cli {

Command completionCommand() {
  auto shell = std::make_shared<std::string>();
  return {.name = "completion",
          .summary = "print what makes a shell complete commands and options",
          .description = "SHELL is bash, zsh or fish. The script knows commands, options and the "
                         "words that an option may have, from the same table as --help.",
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
