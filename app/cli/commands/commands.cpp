#include "app/cli/commands/commands.h"

namespace patina::cli {

std::vector<Command> allCommands() {
  return {infoCommand(),        sceneCommand(),  fieldCommand(), sampleCommand(), feelCommand(),
          simulateCommand(),    paintCommand(),  undoCommand(),  redoCommand(),   embossCommand(),
          renderCommand(),      exportCommand(), studyCommand(), modelCommand(),  devicesCommand(),
          latencyTestCommand(), guiCommand(),    manCommand()};
}

} // namespace patina::cli
