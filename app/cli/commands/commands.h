// Every command, one a source file of the same name (redo beside undo), and their only list.
#pragma once

#include "app/cli/commands/command.h"

namespace patina::cli {

Command infoCommand();
Command sceneCommand();
Command fieldCommand();
Command sampleCommand();
Command feelCommand();
Command simulateCommand();
Command paintCommand();
Command undoCommand();
Command redoCommand();
Command embossCommand();
Command renderCommand();
Command exportCommand();
Command simulateDeviceCommand();
#ifdef PATINA_HAS_ACQUISITION
Command simulateScanCommand();
Command recordCommand();
Command calibrateCommand();
Command trackCommand();
Command filterCommand();
Command registerCommand();
Command fitTextureCommand();
Command mapTextureCommand();
Command scanCommand();
Command demoCommand();
#endif
Command studyCommand();
Command modelCommand();
Command latencyTestCommand();
Command devicesCommand();
Command guiCommand();
Command manCommand();
Command helpCommand();
Command completionCommand();

// In the order in which --help lists them.
inline std::vector<Command> allCommands() {
  return {infoCommand(),           sceneCommand(),    fieldCommand(),      sampleCommand(),
          feelCommand(),           simulateCommand(), paintCommand(),      undoCommand(),
          redoCommand(),           embossCommand(),   renderCommand(),     exportCommand(),
#ifdef PATINA_HAS_ACQUISITION
          simulateScanCommand(),   recordCommand(),   calibrateCommand(),  trackCommand(),
          filterCommand(),         registerCommand(), fitTextureCommand(), mapTextureCommand(),
          scanCommand(),           demoCommand(),
#endif
          simulateDeviceCommand(), studyCommand(),    modelCommand(),      devicesCommand(),
          latencyTestCommand(),    guiCommand(),      helpCommand(),       manCommand(),
          completionCommand()};
}

} // namespace patina::cli
