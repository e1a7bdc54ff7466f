// All commands, each in a source file of its own name (redo in undo's).
#pragma once

#include "app/cli/framework/command.h"

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
Command simulateScanCommand();
Command rigCommand();
Command recordCommand();
Command calibrateCommand();
Command trackCommand();
Command filterCommand();
Command registerCommand();
Command fitTextureCommand();
Command mapTextureCommand();
Command scanCommand();
Command demoCommand();
Command studyCommand();
Command modelCommand();
Command latencyTestCommand();
Command devicesCommand();
Command guiCommand();
Command manCommand();
Command helpCommand();
Command completionCommand();

// All commands, ordered as --help lists them.
inline std::vector<Command> allCommands() {
  return {infoCommand(),       sceneCommand(),        fieldCommand(),    sampleCommand(),
          feelCommand(),       simulateCommand(),     paintCommand(),    undoCommand(),
          redoCommand(),       embossCommand(),       renderCommand(),   exportCommand(),
          rigCommand(),        simulateScanCommand(), recordCommand(),   calibrateCommand(),
          trackCommand(),      filterCommand(),       registerCommand(), fitTextureCommand(),
          mapTextureCommand(), scanCommand(),         demoCommand(),     simulateDeviceCommand(),
          studyCommand(),      modelCommand(),        devicesCommand(),  latencyTestCommand(),
          guiCommand(),        helpCommand(),         manCommand(),      completionCommand()};
}

} // namespace patina::cli
