#include <cerrno>
#include <cstring>
#include <unistd.h>

#include "app/cli/commands.h"
#include "core/error.h"
#include "geometry/mesh_unit.h"

namespace patina::cli {

namespace {

struct GuiOptions {
  std::vector<std::string> inputs;
  std::string unit;
};

int runGui(const GuiOptions& options) {
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe");
  const std::filesystem::path window = self.parent_path() / "patina-gui";
  if (!std::filesystem::exists(window))
    throw Error("this build has no window: " + window.string() +
                " is missing; configure with PATINA_GUI=ON and build again");
  std::vector<std::string> words = {window.string()};
  if (!options.unit.empty()) {
    words.push_back("--unit");
    words.push_back(options.unit);
  }
  words.insert(words.end(), options.inputs.begin(), options.inputs.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(window.c_str(), arguments.data());
  throw Error(window.string() + " cannot be started: " + std::strerror(errno));
}

} // namespace

Command guiCommand() {
  auto options = std::make_shared<GuiOptions>();
  Command command;
  command.name = "gui";
  command.summary = "the window";
  command.description = "Starts patina-gui, which stands beside this program. It needs a display.";
  command.examples = {"patina gui bunny.ply --unit cm"};
  command.reports = false;
  command.arguments.push_back(
      {"INPUT", "INPUT", "Workspace, mesh (.obj .ply .stl) or volume (.vti).", "", false, true,
       [options](const auto& text) { options->inputs.push_back(text); }});
  command.arguments.push_back({"--unit", "mm|cm|m|in|fit", "Unit of a mesh file.", "", false, false,
                               [options](const auto& text) {
                                 (void)parseMeshUnit(text);
                                 options->unit = text;
                               }});
  command.run = [options](Console&) { return runGui(*options); };
  return command;
}

} // namespace patina::cli
