// What every command that writes is given, on small inputs, for tests of how it fails.
#pragma once

#include "integration/painted.h"

namespace patina::test {

enum class Writes { file, folder, workspace };

struct CommandLine {
  std::string name;
  std::vector<std::string> words; // "OUT" stands for the output
  std::string extension;          // of the output
  Writes writes = Writes::file;

  std::vector<std::string> to(const std::string& output) const {
    std::vector<std::string> all = words;
    std::replace(all.begin(), all.end(), std::string("OUT"), output);
    return all;
  }
};

// A painted box as a workspace with three edits, a mesh, tips and points.
class EveryCommand : public Painted {
 protected:
  void SetUp() override {
    Painted::SetUp();
    strokes = three();
    ASSERT_EQ(run({"paint", workspace, "--strokes", strokes, "-o", workspace}).exit, 0);
    tips = folder.write("tips.csv", "t [s],x [m],y [m],z [m]\n0,0,0,0.03\n0.001,0,0,0.019\n");
    points = folder.write("points.csv", "x [m],y [m],z [m]\n0,0,0.021\n0,0,0.01\n");
  }

  std::vector<CommandLine> fileCommands() const {
    return {{"model", {"model", "sphere", "-o", "OUT", "--frequency", "4"}, ".ply"},
            {"field", {"field", box, "-o", "OUT", "--resolution", "40"}, ".vti"},
            {"sample", {"sample", box, "--points", points, "-o", "OUT"}, ".csv"},
            {"feel", {"feel", workspace, "--path", tips, "-o", "OUT"}, ".csv"},
            {"simulate", {"simulate", "--plane", "--seconds", "3", "-o", "OUT"}, ".csv"},
            {"emboss", {"emboss", workspace, "-o", "OUT", "--voxel", "2mm"}, ".obj"}};
  }
  std::vector<CommandLine> folderCommands() const {
    return {
        {"export", {"export", workspace, "-o", "OUT"}, "", Writes::folder},
        {"man", {"man", "-o", "OUT"}, "", Writes::folder},
        {"scene", {"scene", "-o", "OUT", "--add", box}, "", Writes::workspace},
        {"paint", {"paint", workspace, "--strokes", strokes, "-o", "OUT"}, "", Writes::workspace}};
  }
  std::vector<CommandLine> commands() const {
    std::vector<CommandLine> all = fileCommands();
    for (CommandLine& line : folderCommands()) all.push_back(std::move(line));
    return all;
  }

  // Names in the folder, sorted; to see what a command leaves.
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& item : std::filesystem::directory_iterator(folder.path()))
      all.push_back(item.path().filename().string());
    std::sort(all.begin(), all.end());
    return all;
  }

  std::string strokes, tips, points;
};

} // namespace patina::test
