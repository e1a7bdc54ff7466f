// data/scenes: the shipped scenes equal the results of the commands in their README.
#include <gtest/gtest.h>

#include <sstream>

#include "core/file.h"
#include "core/numbers.h"
#include "geometry/tree/triangle_tree.h"
#include "integration/program.h"
#include "support/places.h"
#include "workspace/workspace.h"

namespace patina::test {
namespace {

const std::filesystem::path kScenes = sourceFolder() / "data/scenes";

std::vector<std::string> presets() {
  std::vector<std::string> names;
  for (const auto& item : std::filesystem::directory_iterator(kScenes))
    if (item.is_directory()) names.push_back(item.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> wordsOf(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

TEST(Presets, HaveThePapersSizes) {
  EXPECT_EQ(presets(), (std::vector<std::string>{"dinosaur", "galleon", "pottery"}));
  EXPECT_EQ(loadWorkspace(kScenes / "galleon").objects.at(0).mesh->triangles.size(), 8794u); // K25
  EXPECT_EQ(loadWorkspace(kScenes / "pottery").objects.at(0).mesh->triangles.size(), 4800u);
  for (const std::string& name : presets())
    EXPECT_EQ(loadWorkspace(kScenes / name).field.resolution, 150) << name;
}

TEST(Presets, AreSmall) {
  for (const std::string& name : presets()) {
    std::uintmax_t bytes = 0;
    for (const auto& file : std::filesystem::recursive_directory_iterator(kScenes / name))
      if (file.is_regular_file()) bytes += file.file_size();
    EXPECT_LT(bytes, 500'000u) << name;
  }
}

// Runs the README's own lines in a scratch folder and compares. Positions may differ in the last
// bits between machines' mathematical libraries.
TEST(Presets, AreMadeByTheCommandsInTheirReadme) {
  const ScratchFolder folder;
  std::istringstream readme(readFile(kScenes / "README.md"));
  int lines = 0;
  for (std::string line; std::getline(readme, line);) {
    if (!line.starts_with("    patina ")) continue;
    std::vector<std::string> words = wordsOf(line);
    words.erase(words.begin());
    for (std::string& word : words)
      if (word.starts_with("out/")) word = folder / word.substr(4);
    const Outcome outcome = run(words);
    ASSERT_EQ(outcome.exit, 0) << line << "\n" << outcome.err;
    ++lines;
  }
  ASSERT_GE(lines, 6);
  for (const std::string& name : presets()) {
    SCOPED_TRACE(name);
    const Scene made = loadWorkspace(folder / name);
    const Scene shipped = loadWorkspace(kScenes / name);
    EXPECT_EQ(values(made), values(shipped));
    const TriangleMesh& a = *made.objects.at(0).mesh;
    const TriangleMesh& b = *shipped.objects.at(0).mesh;
    EXPECT_EQ(made.objects[0].name, shipped.objects[0].name);
    EXPECT_EQ(a.triangles, b.triangles);
    ASSERT_EQ(a.positions.size(), b.positions.size());
    for (std::size_t i = 0; i < a.positions.size(); ++i)
      ASSERT_LT((a.positions[i] - b.positions[i]).norm(), 1e-9);
  }
}

TEST(Presets, HaveStages) {
  for (const std::string& name : presets()) {
    const Json info = runJson({"info", (kScenes / name).string()});
    EXPECT_FALSE(info.at("stages").asArray().empty()) << name;
  }
}

// Every preset is pressed at faces spread over it, a sheet also from behind: if the path to a face
// is free, the tip must meet a surface.
TEST(Presets, CanBeTouched) {
  const ScratchFolder folder;
  for (const std::string& name : presets()) {
    const TriangleMesh mesh = *loadWorkspace(kScenes / name).objects.at(0).mesh;
    const TriangleTree tree(mesh);
    int front = 0, behind = 0;
    for (std::size_t face = 0; face < mesh.triangles.size() && front + behind < 8; face += 97) {
      const Vec3 normal = faceNormal(mesh, face);
      if (normal.isZero(0.0)) continue;
      Vec3 centre = Vec3::Zero();
      for (const auto vertex : mesh.triangles[face])
        centre += mesh.positions[static_cast<std::size_t>(vertex)] / 3;
      for (const double side : {1.0, -1.0}) {
        if ((side > 0 ? front : behind) == 4) continue;
        if (side < 0 && name != "galleon") continue; // the others are solid
        const Vec3 out = side * normal.normalized();
        if (tree.closestPoint(centre + 0.003 * out).distance < 0.0029) continue;
        std::string path = "t [s],x [m],y [m],z [m]\n";
        for (int i = 0; i <= 120; ++i) { // from 3 mm off to 0.2 mm within the face's own plane
          const Vec3 tip = centre + (0.003 - 0.0032 * i / 120) * out;
          path += formatNumber(0.001 * i);
          for (const double x : tip) path += "," + formatNumber(x);
          path += "\n";
        }
        SCOPED_TRACE(name + " face " + std::to_string(face) + (side > 0 ? " front" : " behind"));
        const Json felt = runJson({"feel", (kScenes / name).string(), "--path",
                                   folder.write("tip.csv", path), "-o", folder / "f.csv"});
        EXPECT_GT(felt.at("contact_ticks").asInteger(), name == "dinosaur" ? 2 : 25);
        EXPECT_GT(felt.at("max_force").asNumber(), 0.0);
        ++(side > 0 ? front : behind);
      }
    }
    EXPECT_EQ(front, 4) << name;
    EXPECT_EQ(behind, name == "galleon" ? 4 : 0) << name;
  }
}

} // namespace
} // namespace patina::test
