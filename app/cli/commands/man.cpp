#include <sys/mman.h>
#include <unistd.h>

#include "app/cli/commands/commands.h"
#include "app/cli/output/help.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/file.h"
#include "core/staged_folder.h"

namespace patina::cli {

namespace {

struct ManOptions {
  std::filesystem::path folder;
  std::string command;
  bool markdown = false;
};

// Shows the page with the system's man, or as --help if there is none.
int show(const std::string& page, const std::string& text, Console& console) {
  const int file = ::memfd_create("patina.1", 0);
  const auto size = static_cast<ssize_t>(page.size());
  if (file >= 0 && ::write(file, page.data(), page.size()) == size) {
    const std::string name = "/proc/self/fd/" + std::to_string(file);
    ::execlp("man", "man", "-l", name.c_str(), nullptr);
  }
  console.print(text);
  return kDone;
}

int runMan(const ManOptions& options, Console& console) {
  const std::filesystem::path& folder = options.folder;
  if (!options.command.empty() && !folder.empty())
    throw Error("man: " + options.command +
                " is shown on screen; the pages of all are written to -o");
  if (folder.empty()) {
    if (options.markdown) throw Error("--markdown: needs -o FOLDER");
    const std::vector<Command> all = allCommands();
    if (options.command.empty()) return show(programManPage(all), programHelp(all), console);
    const Command& command = commandNamed(all, options.command);
    return show(commandManPage(command), commandHelp(command), console);
  }
  const std::vector<Command> commands = allCommands();
  StagedFolder files(folder, options.markdown ? "command_line.md" : "patina.1");
  if (options.markdown) {
    writeFileAtomically(files.path() / "command_line.md", markdown(commands));
    files.commit();
    console.print((folder / "command_line.md").string() + "\n");
    return kDone;
  }
  writeFileAtomically(files.path() / "patina.1", programManPage(commands));
  std::string list = (folder / "patina.1").string() + "\n";
  for (const Command& command : commands) {
    const std::string page = "patina-" + command.name + ".1";
    writeFileAtomically(files.path() / page, commandManPage(command));
    list += (folder / page).string() + "\n";
  }
  files.commit();
  console.print(list);
  return kDone;
}

} // namespace

Command manCommand() {
  auto options = std::make_shared<ManOptions>();
  return {.name = "man",
          .summary = "show or write the manual pages",
          .description = "Shows the page of a command on screen, with man where it is installed. "
                         "With -o it writes patina.1 and one patina-COMMAND.1 for each command, "
                         "with the text of --help.",
          .examples = {"patina man feel", "patina man -o man/man1"},
          .keys = {},
          .arguments = {input(
                            "COMMAND", "Command of the page; without it the program's.",
                            [options](const std::string& word) { options->command = word; },
                            Times::at_most_once),
                        writtenTo(options->folder, "-o,--output", "FOLDER",
                                  "Where to; made if it is missing."),
                        {"--markdown", "", "", "", "One command_line.md in place of the pages.",
                         into(options->markdown)}},
          .run = [options](Console& console) { return runMan(*options, console); }};
}

} // namespace patina::cli
