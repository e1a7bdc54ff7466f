#include "app/cli/commands/commands.h"
#include "app/cli/output/help.h"
#include "app/cli/output/reports.h"
#include "core/file.h"

namespace patina::cli {

namespace {

struct ManOptions {
  std::filesystem::path folder;
  bool markdown = false;
};

int runMan(const ManOptions& options, Console& console) {
  const std::filesystem::path& folder = options.folder;
  makeFolder(folder);
  const std::vector<Command> commands = allCommands();
  if (options.markdown) {
    writeFileAtomically(folder / "command_line.md", markdown(commands));
    console.print((folder / "command_line.md").string() + "\n");
    return kDone;
  }
  writeFileAtomically(folder / "patina.1", programManPage(commands));
  std::string list = (folder / "patina.1").string() + "\n";
  for (const Command& command : commands) {
    const std::filesystem::path page = folder / ("patina-" + command.name + ".1");
    writeFileAtomically(page, commandManPage(command));
    list += page.string() + "\n";
  }
  console.print(list);
  return kDone;
}

} // namespace

Command manCommand() {
  auto options = std::make_shared<ManOptions>();
  return {.name = "man",
          .summary = "write the manual pages",
          .description = "Writes patina.1 and one patina-COMMAND.1 for each command, with the text "
                         "of --help.",
          .examples = {"patina man -o man/man1 && man -l man/man1/patina-feel.1"},
          .keys = {},
          .arguments = {outputTo(options->folder, "FOLDER", "Where to; made if it is missing."),
                        {"--markdown", "", "", "", "One command_line.md in place of the pages.",
                         into(options->markdown)}},
          .run = [options](Console& console) { return runMan(*options, console); }};
}

} // namespace patina::cli
