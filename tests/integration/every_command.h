// Arguments of every writing command on small inputs, for tests of failures.
#pragma once

#include "integration/painted.h"

namespace patina::test {

// A recording is never overwritten: the hand's motion cannot be repeated.
enum class Writes { file, folder, workspace, recording };

struct CommandLine {
  std::string name;
  std::vector<std::string> words; // "OUT" stands for the output
  std::string extension;          // extension of the output
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

  // Makes the inputs of the scan commands once, if a test needs them.
  void makeScan() const {
    const std::string scan = folder / "scan", path = folder / "path.csv";
    (void)runJson({"simulate-scan", box, "-o", folder / "film", "--seconds", "1", "--frames"});
    (void)runJson({"simulate-scan", box, "-o", scan, "--seconds", "3"});
    (void)runJson({"filter", scan, "-o", path, "--heights", folder / "heights.csv"});
    ASSERT_LT(run({"register", box, path, "-o", folder / "registered.csv"}).exit, 2);
    folder.write("weights.csv", "force [N],reading\n0,0.2\n1,0.7\n2,1.2\n4,2.2\n");
  }
  std::vector<CommandLine> scanFileCommands() const {
    return {{"track", {"track", folder / "film", "-o", "OUT"}, ".tum"},
            {"filter", {"filter", folder / "scan", "-o", "OUT"}, ".csv"},
            {"register", {"register", box, folder / "path.csv", "-o", "OUT"}, ".csv"},
            {"fit-texture", {"fit-texture", folder / "heights.csv", "-o", "OUT"}, ".json"},
            {"map-texture", {"map-texture", box, folder / "registered.csv", "-o", "OUT"}, ".obj"},
            {"calibrate", {"calibrate", folder / "weights.csv", "--force", "-o", "OUT"}, ".json"}};
  }
  std::vector<CommandLine> scanFolderCommands() const {
    const std::string film = "replay:" + (folder / "film");
    return {{"simulate-scan",
             {"simulate-scan", box, "-o", "OUT", "--seconds", "1"},
             "",
             Writes::folder},
            {"record", {"record", film, "--probe", film, "-o", "OUT"}, "", Writes::recording}};
  }

  // Returns the sorted names in the folder, to see what a command leaves.
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
