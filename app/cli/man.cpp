#include "app/cli/commands.h"
#include "app/cli/help.h"
#include "core/error.h"
#include "core/file.h"

namespace patina::cli {

namespace {

int runMan(const std::filesystem::path& folder, Console& console) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder))
    throw FileError(folder.string(), 0, "this folder cannot be made");
  const std::vector<Command> commands = allCommands();
  writeFileAtomically(folder / "patina.1", programManPage(commands));
  std::string list = (folder / "patina.1").string() + "\n";
  for (const Command& command : commands) {
    const std::filesystem::path page = folder / ("patina-" + command.name + ".1");
    writeFileAtomically(page, commandManPage(command));
    list += page.string() + "\n";
  }
  console.report(Json(), list);
  return kDone;
}

} // namespace

Command manCommand() {
  auto folder = std::make_shared<std::filesystem::path>();
  Command command;
  command.name = "man";
  command.summary = "write the manual pages";
  command.description = "Writes patina.1 and one patina-COMMAND.1 for each command, with the text "
                        "of --help.";
  command.examples = {"patina man -o man/man1 && man -l man/man1/patina-feel.1"};
  command.reports = false;
  command.output("FOLDER", "Where to; made if it is missing.", *folder);
  command.run = [folder](Console& console) { return runMan(*folder, console); };
  return command;
}

} // namespace patina::cli
