// Every command, one a source file of the same name (redo beside undo).
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
Command studyCommand();
Command modelCommand();
Command latencyTestCommand();
Command devicesCommand();
Command guiCommand();
Command manCommand();

} // namespace patina::cli
