// Every command on our own data: exit codes, JSON keys and CSV headers.
#include <gtest/gtest.h>

#include <fstream>

#include <cmath>

#include "core/csv.h"
#include "core/file.h"
#include "core/types.h"
#include "integration/program.h"

namespace patina::test {
namespace {

const char* const kForceHeader =
    "t [s],x [m],y [m],z [m],fx [N],fy [N],fz [N],contact,depth [m],vcp_x [m],vcp_y [m],vcp_z "
    "[m],nx,ny,nz,step [ns],fault,held,snap";
const char* const kSampleHeader =
    "x [m],y [m],z [m],phi [m],nx,ny,nz,face,cx [m],cy [m],cz "
    "[m],in_band,stiffness [N/m],friction.static,friction.dynamic,damping "
    "[N s/m],roughness [m],relief [m],red,green,blue,cover,texture [m]";

void expectKeys(const Json& json, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) EXPECT_NE(json.find(key), nullptr) << key;
}

const std::vector<std::string> kFieldKeys = {
    "seconds", "cpu_seconds", "voxel",       "resolution",        "origin",         "band_voxels",
    "blocks",  "bytes",       "dense_bytes", "dropped_triangles", "ambiguous_signs"};

class Commands : public testing::Test {
 protected:
  // A sphere of radius 20 mm, in mm, and a path that presses 1 mm into its top.
  void SetUp() override {
    sphere = folder / "sphere.ply";
    ASSERT_EQ(run({"model", "sphere", "-o", sphere, "--radius", "20mm", "--frequency", "20"}).exit,
              0);
    std::string text = "t [s],x [m],y [m],z [m]\n";
    for (int i = 0; i < 200; ++i) {
      const double z = 0.0215 - 0.000025 * std::min(i, 100);
      text += std::to_string(0.001 * i) + ",0,0," + std::to_string(z) + "\n";
    }
    path = folder.write("tip.csv", text);
  }

  ScratchFolder folder;
  std::string sphere, path;
};

TEST_F(Commands, InfoReportsTheMeshItsLayersAndItsStages) {
  const Json info = runJson({"info", sphere, "--resolution", "60"});
  expectKeys(info, {"triangles", "vertices", "bounds", "watertight", "components", "defects",
                    "layers", "stages"});
  expectKeys(info.at("defects"), {"non_finite", "degenerate", "duplicate", "boundary_edges",
                                  "non_manifold_edges", "misoriented_edges"});
  EXPECT_EQ(info.at("triangles").asInteger(), 20 * 20 * 20);
  EXPECT_TRUE(info.at("watertight").asBool());
  EXPECT_NEAR(info.at("bounds").asArray()[1].asArray()[2].asNumber(), 0.02, 1e-3);
  ASSERT_FALSE(info.at("layers").asArray().empty());
  for (const Json& layer : info.at("layers").asArray()) {
    expectKeys(layer, {"name", "bytes"});
    EXPECT_GT(layer.at("bytes").asInteger(), 0);
  }
  std::vector<std::string> stages;
  for (const Json& stage : info.at("stages").asArray()) {
    expectKeys(stage, {"name", "why", "bytes", "ns"});
    stages.push_back(stage.at("name").asString());
    EXPECT_LT(stage.at("ns").asNumber(), 1e6);
  }
  // A scene with no friction, damping or offset has no stage for them.
  EXPECT_EQ(std::count(stages.begin(), stages.end(), "friction"), 0);
  EXPECT_EQ(std::count(stages.begin(), stages.end(), "limit"), 1);
}

TEST_F(Commands, InfoReportsOpenEdges) {
  const auto sidesOf = [](const Json& info) { return info.at("components_sides").dump(-1); };
  EXPECT_EQ(sidesOf(runJson({"info", sphere, "--no-field"})),
            R"([{"sides":"closed","triangles":8000}])");
  const std::string sheet =
      folder.write("sheet.obj", "v 0 0 0\nv 80 0 0\nv 80 80 0\nv 0 80 0\nf 1 2 3\nf 1 3 4\n");
  const std::string one = R"([{"sides":"one-sided","triangles":2}])";
  EXPECT_EQ(sidesOf(runJson({"info", sheet, "--no-field"})), one);
  EXPECT_EQ(sidesOf(runJson({"info", sheet, "--resolution", "60"})), one);
  EXPECT_NE(
      run({"info", sheet, "--no-field"}).out.find("sides       one-sided: the front of a plate"),
      std::string::npos);
  const std::string both = folder / "both";
  EXPECT_EQ(run({"scene", "-o", both, "--add", sheet, "--add", sphere, "--set", "tip.radius=1mm",
                 "--set", "surface.sides=two"})
                .exit,
            0);
  EXPECT_EQ(sidesOf(runJson({"info", both})),
            R"([{"sides":"closed","triangles":8000},{"sides":"two-sided","triangles":2}])");
}

// The path runs 3 mm below its whole front, and out again beyond its rim.
TEST_F(Commands, OpenTerrainIsTouchedFromItsFront) {
  std::string mesh, tip = "t [s],x [m],y [m],z [m]\n";
  constexpr int kSide = 40;
  const auto height = [](double x, double y) {
    return 0.003 * std::sin(90 * x) * std::cos(70 * y);
  };
  for (int j = 0; j <= kSide; ++j)
    for (int i = 0; i <= kSide; ++i) {
      const double x = 0.1 * i / kSide, y = 0.1 * j / kSide;
      mesh += "v " + std::to_string(1000 * x) + " " + std::to_string(1000 * y) + " " +
              std::to_string(1000 * height(x, y)) + "\n";
    }
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const int a = j * (kSide + 1) + i + 1, b = a + kSide + 1;
      mesh += "f " + std::to_string(a) + " " + std::to_string(a + 1) + " " + std::to_string(b + 1) +
              "\nf " + std::to_string(a) + " " + std::to_string(b + 1) + " " + std::to_string(b) +
              "\n";
    }
  constexpr int kTicks = 1000;
  for (int n = 0; n < kTicks; ++n) {
    const double x = 0.01 + 0.08 * n / kTicks, y = 0.03 + 0.04 * n / kTicks;
    tip += std::to_string(1e-3 * n) + "," + std::to_string(x) + "," + std::to_string(y) + "," +
           std::to_string(height(x, y) - 0.003) + "\n";
  }
  const Json felt = runJson({"feel", folder.write("terrain.obj", mesh), "--path",
                             folder.write("deep.csv", tip), "-o", folder / "felt.csv"});
  EXPECT_EQ(felt.at("contact_ticks").asInteger(), kTicks);
}

TEST_F(Commands, InfoWithoutFieldLeavesLayersAndStagesEmpty) {
  const Json info = runJson({"info", sphere, "--no-field"});
  EXPECT_TRUE(info.at("layers").asArray().empty());
  EXPECT_TRUE(info.at("stages").asArray().empty());
  EXPECT_EQ(info.at("components").asInteger(), 1);
}

TEST_F(Commands, FieldIsWrittenAndOpensAgain) {
  const std::string field = folder / "sphere.vti";
  const Json report = runJson({"field", sphere, "-o", field, "--resolution", "60"});
  expectKeys(report, kFieldKeys);
  EXPECT_EQ(report.at("band_voxels").asNumber(), 8);
  EXPECT_EQ(report.at("dropped_triangles").asInteger(), 0);
  std::int64_t longest = 0;
  for (const Json& n : report.at("resolution").asArray())
    longest = std::max(longest, n.asInteger());
  EXPECT_NEAR(static_cast<double>(longest), 60, 1);
  EXPECT_NEAR(report.at("voxel").asNumber(), 0.04 / (60 - 16), 1e-4);

  const Json info = runJson({"info", field});
  EXPECT_EQ(info.at("kind").asString(), "field");
  EXPECT_EQ(info.at("field").at("band_voxels").asNumber(), 8);
  EXPECT_FALSE(info.at("layers").asArray().empty());
  EXPECT_TRUE(info.at("stages").asArray().empty()); // there is no scene, so no servo's stages
  std::filesystem::copy_file(field, folder / "UPPER.VTI");
  EXPECT_EQ(runJson({"info", folder / "UPPER.VTI"}).at("layers").dump(), info.at("layers").dump());
  EXPECT_EQ(info.at("field").at("voxel").asNumber(), report.at("voxel").asNumber());
  EXPECT_TRUE(info.at("watertight").asBool());
  EXPECT_NEAR(info.at("bounds").asArray()[1].asArray()[0].asNumber(), 0.02, 1e-4);
}

TEST_F(Commands, SampleIsExactOnASphere) {
  const std::string points =
      folder.write("points.csv", "x [m],y [m],z [m]\n0,0,0.021\n0.019,0,0\n0,0.5,0\n0,0,0.001\n");
  const std::string samples = folder / "samples.csv";
  const Json report = runJson({"sample", sphere, "--points", points, "-o", samples});
  EXPECT_EQ(report.at("points").asInteger(), 4);
  EXPECT_EQ(report.at("in_band").asInteger(), 2);
  EXPECT_EQ(firstLine(samples), kSampleHeader);
  const CsvTable table = readCsv(samples, {"x [m]", "y [m]", "z [m]", "phi [m]"});
  ASSERT_EQ(table.rows.size(), 4u);
  const double expected[] = {0.001, -0.001, 0.48, -0.019};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::vector<double>& row = table.rows[i];
    EXPECT_NEAR(row[3], expected[i], 4e-5) << i;
    const Vec3 p(row[0], row[1], row[2]), n(row[4], row[5], row[6]), c(row[8], row[9], row[10]);
    EXPECT_NEAR(n.norm(), 1, 1e-9);
    EXPECT_NEAR(n.dot(p.normalized()), 1, 2e-2);
    EXPECT_NEAR(c.norm(), 0.02, 4e-5);
    EXPECT_GE(row[7], 0);
    EXPECT_LT(row[7], 8000);
    EXPECT_EQ(row[11], i < 2 ? 1 : 0);
    EXPECT_EQ(row[12], 500);
    EXPECT_EQ(row[13], 0);
  }
}

TEST_F(Commands, SampleAlongALineIsTheDistanceFromASphere) {
  const std::string samples = folder / "line.csv";
  const Json report =
      runJson({"sample", sphere, "--line", "0,0,15mm:0,3mm,25mm", "--count", "11", "-o", samples});
  EXPECT_EQ(report.at("points").asInteger(), 11);
  const CsvTable table = readCsv(samples, {"x [m]", "y [m]", "z [m]", "phi [m]"});
  ASSERT_EQ(table.rows.size(), 11u);
  for (std::size_t i = 0; i < 11; ++i) {
    const Vec3 p(table.rows[i][0], table.rows[i][1], table.rows[i][2]);
    EXPECT_NEAR((p - Vec3(0, 0.0003 * double(i), 0.015 + 0.001 * double(i))).norm(), 0, 1e-12);
    EXPECT_NEAR(table.rows[i][3], p.norm() - 0.02, 4e-5) << i;
  }
  expectOneLineError(run({"sample", sphere, "-o", samples}), {"--line"});
  expectOneLineError(run({"sample", sphere, "--line", "0,0,1", "-o", samples}), {"X,Y,Z:X,Y,Z"});
}

TEST_F(Commands, SampleReportsAPointWithoutATable) {
  const Json report = runJson({"sample", sphere, "--at", "0,0,21mm", "--at", "0,0.5,0"});
  const auto& points = report.at("at").asArray();
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NEAR(points[0].at("phi").asNumber(), 0.001, 4e-5);
  EXPECT_NEAR(points[0].at("gradient").asArray()[2].asNumber(), 1, 2e-3);
  EXPECT_EQ(points[0].at("stiffness").asNumber(), 500);
  EXPECT_TRUE(points[0].at("in_band").asBool());
  EXPECT_NEAR(points[1].at("phi").asNumber(), 0.48, 4e-5);
  EXPECT_FALSE(points[1].at("in_band").asBool());
  expectOneLineError(run({"sample", sphere}), {"--points, --line, --at or --pins"});
  expectOneLineError(run({"sample", sphere, "--pins", "--at", "0,0,0"}), {"--pins"});
}

TEST_F(Commands, PinsOfAWorkspaceAreSampledByName) {
  const std::string scene = folder / "pinned";
  ASSERT_EQ(
      run({"scene", "-o", scene, "--add", sphere, "--set", "pins=top=0,0,21mm;far=0,0,60mm"}).exit,
      0);
  const std::string table = folder / "pins.csv";
  const Json report = runJson({"sample", scene, "--pins", "-o", table});
  const auto& pins = report.at("at").asArray();
  EXPECT_EQ(pins.at(0).at("pin").asString(), "top");
  // A pin beyond the band has exact values, as a point has.
  EXPECT_FALSE(pins.at(1).at("in_band").asBool());
  EXPECT_NEAR(pins.at(1).at("phi").asNumber(), 0.04, 4e-5);
  EXPECT_NEAR(pins.at(1).at("closest").asArray().at(2).asNumber(), 0.02, 4e-5);
  EXPECT_EQ(readFile(table).substr(0, 4), "pin,");
  EXPECT_NE(readFile(table).find("\ntop,0,0,0.021,"), std::string::npos);
}

TEST_F(Commands, SampleOfAFieldFileEqualsThatOfItsMesh) {
  const std::string field = folder / "sphere.vti";
  const std::string points =
      folder.write("points.csv", "x [m],y [m],z [m]\n0.003,0.002,0.0205\n0.019,0.001,-0.004\n");
  ASSERT_EQ(run({"field", sphere, "-o", field}).exit, 0);
  ASSERT_EQ(run({"sample", sphere, "--points", points, "-o", folder / "a.csv"}).exit, 0);
  ASSERT_EQ(run({"sample", field, "--points", points, "-o", folder / "b.csv"}).exit, 0);
  const CsvTable a = readCsv(folder / "a.csv", {}), b = readCsv(folder / "b.csv", {});
  ASSERT_EQ(a.rows.size(), b.rows.size());
  EXPECT_EQ(b.columns.size(), 12u) << "a field has no material";
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    for (std::size_t j = 3; j < 7; ++j) EXPECT_NEAR(a.rows[i][j], b.rows[i][j], 1e-7);
    for (std::size_t j = 8; j < 11; ++j) EXPECT_NEAR(a.rows[i][j], b.rows[i][j], 3e-5);
  }
}

TEST_F(Commands, FeelGivesHookesForceAndItsReport) {
  const std::string forces = folder / "forces.csv";
  const Json report = runJson({"feel", sphere, "--path", path, "-o", forces, "--stiffness", "800"});
  expectKeys(report, {"ticks", "stages", "step_ns", "contact_ticks", "max_force", "field"});
  expectKeys(report.at("step_ns"), {"p50", "p99", "p999", "max"});
  expectKeys(report.at("field"), kFieldKeys);
  EXPECT_EQ(report.at("ticks").asInteger(), 200);
  EXPECT_EQ(firstLine(forces), kForceHeader);
  const CsvTable table = readCsv(forces, {"t [s]"});
  ASSERT_EQ(table.rows.size(), 200u);
  EXPECT_EQ(table.rows[10][7], 0); // out of contact
  EXPECT_EQ(table.rows[10][6], 0);
  const std::vector<double>& pressed = table.rows[199];
  EXPECT_EQ(pressed[7], 1);
  EXPECT_NEAR(pressed[6], 0.8, 0.02); // 1 mm at 800 N/m, straight up
  EXPECT_NEAR(pressed[8], 0.001, 3e-5);
  EXPECT_NEAR(report.at("max_force").asNumber(), 0.8, 0.02);
}

TEST_F(Commands, FeelReportsAPathWithoutContact) {
  const std::string far = folder / "far.csv";
  std::ofstream(far) << "t [s],x [m],y [m],z [m]\n0,1,1,1\n0.001,1,1,1\n";
  const std::string forces = folder / "forces.csv";
  const Outcome missed = run({"feel", sphere, "--path", far, "-o", forces, "--resolution", "40"});
  EXPECT_EQ(missed.exit, 0);
  EXPECT_NE(missed.err.find("never touches"), std::string::npos) << missed.err;
  const Outcome met = run({"feel", sphere, "--path", path, "-o", forces, "--resolution", "40"});
  EXPECT_EQ(met.err.find("never touches"), std::string::npos) << met.err;
}

TEST_F(Commands, FeelOptionsReachTheServo) {
  const std::string forces = folder / "forces.csv";
  const Json report = runJson({"feel",
                               sphere,
                               "--path",
                               path,
                               "-o",
                               forces,
                               "--force-limit",
                               "0.1",
                               "--friction-static",
                               "0.5",
                               "--friction-dynamic",
                               "0.3",
                               "--tip-radius",
                               "0.5mm",
                               "--damping",
                               "2",
                               "--sampler",
                               "kim",
                               "--voxel",
                               "0.5mm",
                               "--band",
                               "6"});
  EXPECT_NEAR(report.at("max_force").asNumber(), 0.1, 1e-9);
  EXPECT_NEAR(report.at("field").at("voxel").asNumber(), 0.0005, 1e-12);
  EXPECT_EQ(report.at("field").at("band_voxels").asNumber(), 6);
  std::string stages;
  for (const Json& stage : report.at("stages").asArray()) stages += stage.asString() + " ";
  EXPECT_NE(stages.find("friction"), std::string::npos) << stages;
  EXPECT_NE(stages.find("damping"), std::string::npos) << stages;
}

TEST_F(Commands, UnitScalesTheMeshAndAnImplausibleSizeCausesAWarning) {
  const Json mm = runJson({"info", sphere, "--no-field"});
  const Json cm = runJson({"info", sphere, "--no-field", "--unit", "cm"});
  const double z_mm = mm.at("bounds").asArray()[1].asArray()[2].asNumber();
  EXPECT_NEAR(cm.at("bounds").asArray()[1].asArray()[2].asNumber(), 10 * z_mm, 1e-12);
  const Json fit = runJson({"info", sphere, "--no-field", "--unit", "fit"});
  const auto& box = fit.at("bounds").asArray();
  double longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    longest =
        std::max(longest, box[1].asArray()[axis].asNumber() - box[0].asArray()[axis].asNumber());
  EXPECT_NEAR(longest, 0.1, 1e-9);

  const Outcome huge = run({"info", sphere, "--no-field", "--unit", "m"});
  EXPECT_EQ(huge.exit, 0);
  EXPECT_NE(huge.err.find("--unit"), std::string::npos) << huge.err;
  EXPECT_EQ(run({"info", sphere, "--no-field"}).err, "");
}

TEST_F(Commands, ModelsAreWrittenInEveryFormatAndReadBackEqual) {
  for (const std::string name : {"sphere", "torus", "box", "plate", "vase", "galleon"})
    for (const std::string extension : {".obj", ".ply", ".stl"}) {
      const std::string mesh = folder / (name + extension);
      const Json made = runJson({"model", name, "-o", mesh});
      const Json info = runJson({"info", mesh, "--no-field"});
      EXPECT_EQ(info.at("triangles").asInteger(), made.at("triangles").asInteger()) << mesh;
      EXPECT_EQ(info.at("watertight").asBool(), made.at("watertight").asBool()) << mesh;
      for (std::size_t end = 0; end < 2; ++end)
        for (std::size_t axis = 0; axis < 3; ++axis)
          EXPECT_NEAR(info.at("bounds").asArray()[end].asArray()[axis].asNumber(),
                      made.at("bounds").asArray()[end].asArray()[axis].asNumber(), 1e-7)
              << mesh;
    }
}

TEST_F(Commands, DinosaurIsOneClosedSurfaceOfTheSizeOfAToy) {
  const Json made = runJson({"model", "dinosaur", "-o", folder / "d.ply", "--resolution", "100"});
  EXPECT_TRUE(made.at("watertight").asBool());
  const Json info = runJson({"info", folder / "d.ply", "--no-field"});
  EXPECT_EQ(info.at("components").asInteger(), 1);
}

TEST_F(Commands, LatencyTestReportsLatenessPolicyAndLoad) {
  const Json report = runJson({"latency-test", "--seconds", "0.3"});
  expectKeys(report, {"policy", "wakeups", "late_us", "missed", "load"});
  expectKeys(report.at("late_us"), {"p50", "p99", "p999", "max"});
  EXPECT_EQ(report.at("wakeups").asInteger(), 300);
  EXPECT_LE(report.at("late_us").at("p50").asNumber(), report.at("late_us").at("max").asNumber());
  const Json* wait = report.find("wait_us");
  if (wait) expectKeys(*wait, {"p50", "p99", "p999", "max"});
  const std::string text = run({"latency-test", "--seconds", "0.1"}).out;
  EXPECT_EQ(text.find("waiting for a processor, p99.9") != std::string::npos, wait != nullptr)
      << text;
}

TEST_F(Commands, DevicesListsTheBuiltInOnes) {
  for (const bool diagnose : {false, true}) {
    const Json report = diagnose ? runJson({"devices", "--diagnose"}) : runJson({"devices"});
    std::string names;
    for (const Json& device : report.at("devices").asArray())
      names += device.at("name").asString() + " ";
    for (const char* name : {"mouse", "simulated", "replay"})
      EXPECT_NE(names.find(name), std::string::npos) << names;
    EXPECT_EQ(report.find("policy") != nullptr, diagnose);
  }
}

TEST_F(Commands, SceneRefusesUnsuitableDevices) {
  for (const char* name : {"telephone", "replay"}) {
    const Outcome outcome = run(
        {"scene", "-o", folder / "felt", "--add", sphere, "--set", std::string("device=") + name});
    EXPECT_EQ(outcome.exit, 2);
    EXPECT_TRUE(outcome.err.starts_with("patina: device = " + std::string(name) +
                                        ": it must be mouse or simulated"))
        << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "felt"));
  }
}

TEST_F(Commands, ExportWritesFilesForParaView) {
  const Json report =
      runJson({"export", sphere, "-o", folder / "out", "--path", path, "--resolution", "60"});
  for (const Json& file : report.at("files").asArray())
    EXPECT_TRUE(std::filesystem::exists(folder / ("out/" + file.asString()))) << file.asString();
  EXPECT_EQ(firstLine(folder / "out/forces.csv"), kForceHeader);
  for (const std::string name : {"mesh.vtp", "surface.vtp", "field.vti", "path.vtp"})
    EXPECT_NE(readFile(folder / "out/scene.vtm").find(name), std::string::npos) << name;
  // The field passes through the vertices of its own mesh.
  const CsvTable vertices = readCsv(folder / "out/vertices.csv", {"x [m]", "y [m]", "z [m]"});
  ASSERT_EQ(vertices.rows.size(), 10u * 20 * 20 + 2);
  for (const std::vector<double>& row : vertices.rows) EXPECT_LT(std::abs(row[3]), 3e-5);
}

TEST_F(Commands, TextReportsAreAlignedAndOnStdout) {
  const Outcome info = run({"info", sphere, "--no-field"});
  EXPECT_EQ(info.exit, 0);
  EXPECT_EQ(info.err, "");
  EXPECT_NE(info.out.find("triangles   8,000\n"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("watertight  yes\n"), std::string::npos) << info.out;
}

} // namespace
} // namespace patina::test
