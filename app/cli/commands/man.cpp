#include "app/cli/commands/commands.h"
#include "app/cli/output/help.h"
#include "core/error.h"
#include "core/file.h"

namespace patina::cli {

namespace {

struct ManOptions {
  std::filesystem::path folder;
  bool markdown = false;
};

int runMan(const ManOptions& options, Console& console) {
  const std::filesystem::path& folder = options.folder;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder))
    throw FileError(folder.string(), 0, "this folder cannot be made");
  const std::vector<Command> commands = allCommands();
  if (options.markdown) {
    writeFileAtomically(folder / "command_line.md", markdown(commands));
    console.report(Json(), (folder / "command_line.md").string() + "\n");
    return kDone;
  }
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
  auto options = std::make_shared<ManOptions>();
  Command command;
  command.name = "man";
  command.summary = "write the manual pages";
  command.description = "Writes patina.1 and one patina-COMMAND.1 for each command, with the text "
                        "of --help.";
  command.examples = {"patina man -o man/man1 && man -l man/man1/patina-feel.1"};
  command.reports = false;
  command.output("FOLDER", "Where to; made if it is missing.", options->folder);
  command.flag("--markdown", "One command_line.md in place of the pages.", options->markdown);
  command.run = [options](Console& console) { return runMan(*options, console); };
  return command;
}

} // namespace patina::cli
