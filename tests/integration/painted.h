// Workspaces to paint on, strokes as files, and fingerprints of folders.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/csv.h"
#include "core/file.h"
#include "core/sha256.h"
#include "integration/program.h"
#include "scene/stroke.h"
#include "support/same_scene.h"
#include "workspace/workspace.h"

namespace patina::test {

// Every file's name and content.
inline std::string fingerprint(const std::filesystem::path& folder) {
  std::vector<std::string> lines;
  for (const auto& item : std::filesystem::recursive_directory_iterator(folder))
    lines.push_back(std::filesystem::relative(item.path(), folder).string() + " " +
                    (item.is_regular_file() ? sha256(readFile(item.path())) : "folder"));
  std::sort(lines.begin(), lines.end());
  std::string all;
  for (const std::string& line : lines) all += line + "\n";
  return all;
}

// A hard brush: its weight is 1 up to its edge.
inline Stroke stroke(Tool tool, double value, double radius, const std::vector<Vec3>& path) {
  Stroke result;
  result.brush.tool = tool;
  result.brush.value = value;
  result.brush.radius = radius;
  result.brush.falloff = 1e4;
  for (const Vec3& p : path)
    result.samples.push_back({0.01 * static_cast<double>(result.samples.size()), p, 0});
  return result;
}

// A box of 60 x 50 x 40 mm, whose top is z = 20 mm, as a workspace with voxels of 1 mm.
class Painted : public testing::Test {
 protected:
  void SetUp() override {
    box = folder / "box.ply";
    ASSERT_EQ(run({"model", "box", "-o", box}).exit, 0);
    workspace = folder / "box";
    ASSERT_EQ(run({"scene", "-o", workspace, "--add", box, "--set", "voxel=1mm", "--set",
                   "paint.size=256"})
                  .exit,
              0);
  }

  static constexpr double kTop = 0.02;

  std::string script(const std::string& name, const std::vector<Stroke>& strokes) const {
    return folder.write(name, toJson(strokes).dump());
  }
  std::string three() const {
    return script("three.json",
                  {stroke(Tool::material(MaterialChannel::stiffness), 900, 0.006, {{0, 0, kTop}}),
                   stroke(Tool::relief, 5e-4, 0.008, {{-0.01, 0, kTop}, {0.01, 0.005, kTop}}),
                   stroke(Tool::color, 0, 0.005, {{0.02, 0, kTop}})});
  }
  // A path pressed straight down at (x, y), `depth` deep.
  std::string pressAt(double x, double y, double depth) const {
    std::string text = "t [s],x [m],y [m],z [m]\n";
    for (int i = 0; i <= 200; ++i)
      text += std::to_string(0.001 * i) + "," + std::to_string(x) + "," + std::to_string(y) + "," +
              std::to_string(kTop + 1e-3 - (1e-3 + depth) * i / 200) + "\n";
    return folder.write("press.csv", text);
  }
  // Returns the last row of `patina feel`.
  std::vector<double> hapticLast(const std::string& input, const std::string& path) const {
    const std::string out = folder / "felt.csv";
    const Outcome outcome = run({"feel", input, "--path", path, "-o", out});
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    return outcome.exit == 0 ? readCsv(out, {"t [s]"}).rows.back() : std::vector<double>(15);
  }

  ScratchFolder folder;
  std::string box, workspace;
};

} // namespace patina::test
