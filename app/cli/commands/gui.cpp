#include <cerrno>
#include <cstring>
#include <unistd.h>

#include "app/cli/commands/commands.h"
#include "core/error.h"
#include "core/numbers.h"
#include "geometry/mesh/mesh_unit.h"

namespace patina::cli {

namespace {

struct GuiOptions {
  std::filesystem::path input;
  std::vector<std::string> words; // arguments for the window, checked here
};

int runGui(const GuiOptions& options) {
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe");
  const std::filesystem::path window = self.parent_path() / "patina-gui";
  if (!std::filesystem::exists(window))
    throw Error("the window is not built: " + window.string() +
                " is missing; app/run.sh builds it where there is a display, or ninja -C BUILD "
                "patina-gui, with PATINA_GUI=ON");
  std::vector<std::string> words = {window.string()};
  words.insert(words.end(), options.words.begin(), options.words.end());
  if (!options.input.empty()) {
    if (!std::filesystem::exists(options.input))
      throw FileError(options.input.string(), 0, "no such file or folder");
    words.push_back(options.input.string());
  }
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(window.c_str(), arguments.data());
  throw Error(window.string() + " cannot be started: " + std::strerror(errno));
}

} // namespace

Command guiCommand() {
  auto options = std::make_shared<GuiOptions>();
  const auto pass = [options](const std::string& name, auto check) {
    return [options, name, check](const std::string& text) {
      check(text);
      options->words.push_back(name);
      if (!text.empty()) options->words.push_back(text);
    };
  };
  const auto anything = [](const std::string&) {};
  const auto number = [](const std::string& text) {
    if (!parseNumber(text)) throw Error("'" + text + "' is not a number");
  };
  return {
      .name = "gui",
      .summary = "the window",
      .description =
          "Starts patina-gui, which is installed beside this program and has the same options. It "
          "needs a display; on a machine without one start it under xvfb-run -a.",
      .examples = {"patina gui bunny.ply --unit cm", "patina gui workspace --log session.csv"},
      .keys = {},
      .arguments =
          {input("INPUT",
                 "Workspace, mesh (.obj .ply .stl) or volume (.vti); without one, a page to "
                 "begin from, or with --log the toy dinosaur.",
                 into(options->input), Times::at_most_once),
           {"--unit", "mm|cm|m|in|fit", "", "mm", "Unit of a mesh file.",
            pass("--unit", parseMeshUnit)},
           {"--up", "z|y", "", "", "Axis of a mesh file that points upwards.",
            pass("--up", parseUpAxis)},
           {"--iso", "VALUE", "", "", "Value at which a volume (.vti) from elsewhere is a surface.",
            pass("--iso", number)},
           {"--log", "FORCES.csv", "", "", "Record every tick, on disk within a second.",
            pass("--log", anything)},
           {"--demo", "", "", "", "From a scan to a feel on the toy, step by step in the window.",
            pass("--demo", anything)},
           {"--first-picture-time", "", "", "",
            "Print the seconds from start to the first picture.",
            pass("--first-picture-time", anything)}},
      .run = [options](Console& console) {
        console.endOnInterrupt();
        return runGui(*options);
      }};
}

} // namespace patina::cli
