// A Fourier texture on a mesh is rendered, kept in a workspace and exchanged, by commands.
#include <cmath>

#include <gtest/gtest.h>

#include "core/csv.h"
#include "core/file.h"
#include "integration/program.h"
#include "support/constants.h"

namespace patina::test {
namespace {

class TexturedFeel : public testing::Test {
 protected:
  void SetUp() override {
    plane = folder / "plane.obj";
    bare = folder / "bare.obj";
    path = folder / "tip.csv";
    // The plane of Andrews and Lang's figure 10, turned so that z is up: x from 0 to 50 mm,
    // over 80.
    const std::string mesh = "v -40 -40 0\nv -40 40 0\nv 40 -40 0\nv 40 40 0\nf 1 3 2\nf 2 3 4\n";
    writeFileAtomically(bare, mesh);
    writeFileAtomically(plane, mesh + "h 1 0 0 50 0 0 50\nh 1 0 50 50 0 50 50\n");
    std::string rows = "t [s],x [m],y [m],z [m]\n";
    for (int i = 0; i < 400; ++i)
      rows +=
          std::to_string(i * 1e-3) + "," + std::to_string(-0.02 + 1e-4 * i) + ",0.003,-0.0005\n";
    writeFileAtomically(path, rows);
    writeTexture("t.json", 5e-3, 1e-4);
  }
  void writeTexture(const std::string& name, double length, double height,
                    const std::string& more = "") {
    char text[600];
    std::snprintf(text, sizeof text,
                  "{\"format\": \"patina texture\", \"version\": 1, \"kind\": \"line\", "
                  "\"harmonics\": 1, \"omega\": %.17g, \"low\": %.17g, \"a\": [%.17g], \"b\": "
                  "[0]%s}\n",
                  2 * kPi / length, -height, height, more.c_str());
    writeFileAtomically(folder / name, text);
  }
  // Returns fz at each x.
  std::vector<std::pair<double, double>> feel(std::vector<std::string> args) {
    args.insert(args.begin(), "feel");
    args.insert(args.end(), {"--path", path, "-o", folder / "forces.csv", "--resolution", "80"});
    EXPECT_EQ(run(args).exit, 0);
    std::vector<std::pair<double, double>> found;
    const CsvTable table = readCsv(
        folder / "forces.csv", {"t [s]", "x [m]", "y [m]", "z [m]", "fx [N]", "fy [N]", "fz [N]"});
    for (const auto& row : table.rows) found.emplace_back(row[1], row[6]);
    return found;
  }
  void expectWave(const std::vector<std::pair<double, double>>& felt, double length, double height,
                  double stiffness) {
    for (const auto& [x, force] : felt) {
      const double along = (x + 0.04) * 50 / 80; // coordinates differ from the mesh's
      EXPECT_NEAR(force, stiffness * (0.5e-3 + height * std::cos(2 * kPi * along / length)),
                  stiffness * 2e-6)
          << x;
    }
  }
  ScratchFolder folder;
  std::string plane, bare, path;
};

TEST_F(TexturedFeel, RendersTheHeightAtTheCoordinates) {
  expectWave(feel({plane, "--texture", "1=" + (folder / "t.json")}), 5e-3, 1e-4, 500);
}

TEST_F(TexturedFeel, HasTheStiffnessOfItsCompliance) {
  writeTexture("soft.json", 5e-3, 1e-4, ", \"compliance\": 0.005");
  expectWave(feel({plane, "--texture", "1=" + (folder / "soft.json")}), 5e-3, 1e-4, 200);
}

// T-A25
TEST_F(TexturedFeel, EqualsTheBareMeshWithoutItsFile) {
  const auto rigid = feel({plane}), without = feel({bare});
  EXPECT_EQ(rigid, without);
  EXPECT_NE(run({"feel", plane, "--path", path, "-o", folder / "f.csv", "--resolution", "80"})
                .err.find("2 faces have the texture 1"),
            std::string::npos);
}

TEST_F(TexturedFeel, IsKeptInAWorkspaceExchangedAndUndone) {
  const std::string work = folder / "work";
  writeTexture("other.json", 3e-3, 5e-5);
  EXPECT_EQ(
      run({"scene", "-o", work, "--add", plane, "--texture", "1=" + (folder / "t.json")}).exit, 0);
  expectWave(feel({work}), 5e-3, 1e-4, 500);
  EXPECT_EQ(run({"scene", "-o", work, "--texture", "1=" + (folder / "other.json")}).exit, 0);
  expectWave(feel({work}), 3e-3, 5e-5, 500);
  EXPECT_EQ(run({"undo", work}).exit, 0);
  expectWave(feel({work}), 5e-3, 1e-4, 500);
  // A layer next to the rigid surface: its profile stands on the plane.
  const auto layered = feel({work, "--texture-gain", "0.4"});
  for (const auto& [x, force] : layered) {
    const double along = (x + 0.04) * 50 / 80;
    const double h = 1e-4 * (1 + std::cos(2 * kPi * along / 5e-3));
    EXPECT_NEAR(force, 500 * (0.5e-3 + 0.4 * (0.5e-3 + h)), 5e-3) << x;
  }
}

// F7: 0.1 mm at 1 mm is 1,300 N/m along the surface at 0.33 N, at any stiffness.
TEST_F(TexturedFeel, ReportsALayerTooStiffForTheDevice) {
  const std::string work = folder / "work";
  writeTexture("sharp.json", 1e-3, 1e-4);
  const auto told = [&] { return run({"feel", work, "--path", path, "-o", folder / "f.csv"}).err; };
  ASSERT_EQ(
      run({"scene", "-o", work, "--add", plane, "--texture", "1=" + (folder / "sharp.json"),
           "--set", "resolution=80", "--set", "device.mass=0.05", "--set", "device.damping=0.5"})
          .exit,
      0);
  EXPECT_EQ(told().find("as a layer"), std::string::npos);
  ASSERT_EQ(run({"scene", "-o", work, "--set", "texture.gain=0.4"}).exit, 0);
  EXPECT_NE(told().find("too sharp for this device to render stably as a layer"),
            std::string::npos);
}

TEST_F(TexturedFeel, ReportsTheCauseOfErrors) {
  const std::string out = folder / "none.csv";
  const auto feels = [&](const std::string& texture) {
    return run({"feel", plane, "--path", path, "-o", out, "--texture", texture});
  };
  expectOneLineError(feels("1"), {"ID=T.json"});
  expectOneLineError(feels("x=" + (folder / "t.json")), {"ID=T.json"});
  const Outcome other = feels("2=" + (folder / "t.json"));
  EXPECT_EQ(other.exit, 2);
  EXPECT_NE(other.err.find("texture 2: no face has it"), std::string::npos);
  expectOneLineError(feels("1=" + (folder / "missing.json")), {"missing.json"});
  writeTexture("bad.json", 5e-3, 1e-4, ", \"compliance\": -1");
  expectOneLineError(feels("1=" + (folder / "bad.json")), {"bad.json", "compliance"});
  EXPECT_FALSE(std::filesystem::exists(out));
}

} // namespace
} // namespace patina::test
