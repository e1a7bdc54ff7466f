// Bad input: one line with file and line, exit 2, no output file.
#include <gtest/gtest.h>

#include <set>
#include <sys/stat.h>

#include "core/file.h"
#include "integration/program.h"
#include "support/places.h"

namespace patina::test {
namespace {

class BadInput : public testing::Test {
 protected:
  void SetUp() override {
    box = folder / "box.obj";
    ASSERT_EQ(run({"model", "box", "-o", box}).exit, 0);
    path = folder.write("tip.csv", "t [s],x [m],y [m],z [m]\n0,0,0,0.1\n0.001,0,0,0.09\n");
    out = folder / "out.csv";
  }
  Outcome feel(const std::string& mesh, const std::string& tips) const {
    return run({"feel", mesh, "--path", tips, "-o", out, "--resolution", "40"});
  }

  ScratchFolder folder;
  std::string box, path, out;
};

TEST_F(BadInput, MalformedMeshesOfEveryReaderGiveOneLine) {
  const std::filesystem::path root = sourceFolder() / "tests/geometry/malformed";
  int seen = 0;
  std::set<std::string> readers;
  for (const auto& file : std::filesystem::recursive_directory_iterator(root)) {
    const std::string extension = file.path().extension().string();
    if (extension != ".obj" && extension != ".ply" && extension != ".stl") continue;
    SCOPED_TRACE(file.path().string());
    expectOneLineError(run({"info", file.path().string()}), {file.path().filename().string()});
    readers.insert(extension);
    ++seen;
  }
  EXPECT_EQ(readers.size(), 3u);
  EXPECT_GT(seen, 20);
}

TEST_F(BadInput, MeshErrorsNameTheLine) {
  const std::string mesh = folder.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999\n");
  expectOneLineError(feel(mesh, path), {"bad.obj:4:"});
  const std::string comma = folder.write("comma.obj", "v 0,5 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expectOneLineError(feel(comma, path), {"comma.obj:1:"});
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(BadInput, TablesNameTheLineAndTheDecimalComma) {
  const std::string header = "t [s],x [m],y [m],z [m]\n";
  expectOneLineError(feel(box, folder.write("a.csv", "time,x,y,z\n0,0,0,0\n")), {"a.csv:1:"});
  expectOneLineError(feel(box, folder.write("b.csv", header + "0,0,0,1\n0,001,0,0,1\n")),
                     {"b.csv:3:"});
  expectOneLineError(feel(box, folder.write("c.csv", "t [s];x [m];y [m];z [m]\n0;0,5,0;1\n")),
                     {"c.csv:2:"});
  expectOneLineError(feel(box, folder.write("d.csv", header + "0,0,0,1\n0,0,0,1\n")),
                     {"d.csv:3:", "time does not increase"});
  expectOneLineError(feel(box, folder.write("e.csv", header + "nan,0,0,1\n")), {"e.csv:2:"});
  expectOneLineError(feel(box, folder.write("f.csv", header)), {"f.csv"});
  expectOneLineError(feel(box, folder.write("g.csv", header + "0,0,0,one\n")), {"g.csv:2:", "one"});
  expectOneLineError(feel(box, folder.write("h.csv", "")), {"h.csv"});
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(BadInput, NamesMissingFiles) {
  expectOneLineError(feel(folder / "none.ply", path), {"none.ply"});
  expectOneLineError(feel(box, folder / "none.csv"), {"none.csv"});
  expectOneLineError(feel(folder.path().string(), path),
                     {folder.path().filename().string(), "is a folder without workspace.json"});
  expectOneLineError(run({"info", folder.write("mesh.xyz", "1 2 3")}), {"mesh.xyz"});
  expectOneLineError(run({"info", folder.write("empty.vti", "")}), {"empty.vti"});
}

TEST_F(BadInput, NamesUnwritableOutputs) {
  expectOneLineError(run({"feel", box, "--path", path, "-o", folder / "no/such/f.csv"}),
                     {"f.csv", "no folder"});
  expectOneLineError(run({"feel", box, "--path", path, "-o", folder.path().string()}),
                     {"it is a folder"});
  expectOneLineError(run({"field", box, "-o", folder / "field.raw"}), {".vti"});
  // Renaming a file over a device would remove the device.
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  expectOneLineError(run({"feel", box, "--path", path, "-o", folder / "pipe"}),
                     {"pipe", "without a reader"});
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe")); // it is unchanged
  expectOneLineError(run({"model", "box", "-o", folder / "box.xyz"}), {"box.xyz"});
  expectOneLineError(run({"export", box, "-o", box, "--resolution", "40"}), {"box.obj"});
  expectOneLineError(run({"man", "-o", box}), {"box.obj"});
}

TEST_F(BadInput, RefusesAWorkspacesOwnFilesAsOutputs) {
  const std::string scene = folder / "scene";
  ASSERT_EQ(run({"scene", "-o", scene, "--add", box}).exit, 0);
  const std::string heights = folder.write("heights.csv", [] {
    std::string text = "along [m],height [m]\n";
    for (int i = 0; i < 200; ++i)
      text += std::to_string(1e-4 * i) + "," + (i % 20 < 10 ? "1e-5" : "-1e-5") + "\n";
    return text;
  }());
  ASSERT_EQ(run({"fit-texture", heights, "-o", folder / "wave.json"}).exit, 0);
  expectOneLineError(run({"fit-texture", heights, "-o", scene + "/workspace.json"}),
                     {"workspace.json", "belongs to the workspace"});
  EXPECT_EQ(run({"info", scene}).exit, 0);
}

TEST_F(BadInput, DoesNotReadAnEndlessDeviceUntilMemoryEnds) {
  std::filesystem::create_symlink("/dev/zero", folder / "zero.ply");
  expectOneLineError(run({"info", folder / "zero.ply"}), {"zero.ply", "does not end"});
}

TEST_F(BadInput, WarnsOfOptionsWithoutEffect) {
  const auto warned = [&](const std::vector<std::string>& more, const std::string& part) {
    std::vector<std::string> words = {"feel", box, "--path", path, "-o", folder / "f.csv"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("patina: warning: " + part), std::string::npos) << outcome.err;
  };
  warned({"--friction-depth", "1"}, "--friction-depth has no effect without --friction-static");
  warned({"--magnet-fades", "on"}, "--magnet-fades has no effect without --magnet-range");
  warned({"--damping-cutoff", "50"}, "--damping-cutoff has no effect without --damping");
  warned({"--texture-gain", "2"}, "--texture-gain has no effect without a texture");
  warned({"--voxel", "2mm", "--resolution", "60"}, "--resolution has no effect beside --voxel");
  warned({"--stiffness", "5", "--stiffness", "6"}, "--stiffness is given 2 times");
  const Outcome quiet = run({"feel", box, "--path", path, "-o", folder / "f.csv", "--damping", "1",
                             "--damping-cutoff", "50"});
  EXPECT_EQ(quiet.err.find("no effect"), std::string::npos) << quiet.err;
}

TEST_F(BadInput, KeepsLettersOfNamesAndUnitsOfPoses) {
  const std::string cup = folder / "Gef\xc3\xa4\xc3\x9f.obj", scene = folder / "w";
  std::filesystem::copy(box, cup);
  ASSERT_EQ(run({"scene", "-o", scene, "--add", cup}).exit, 0);
  EXPECT_NE(run({"scene", "-o", scene}).out.find("Gef\xc3\xa4\xc3\x9f"), std::string::npos);
  expectOneLineError(run({"scene", "-o", scene, "--add", box + "@"}), {"no pose after the '@'"});
  const std::string far = folder.write("far.txt", "1 0 0 1e300\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  expectOneLineError(run({"scene", "-o", scene, "--add", box + "@" + far}), {"1e+300", "farthest"});
  // Equal meshes are stored once, also under different names.
  ASSERT_EQ(run({"scene", "-o", scene, "--add", cup, "--add", box}).exit, 0);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scene + "/meshes"), {}), 1);
}

TEST_F(BadInput, ChecksTheCommandLinesWords) {
  expectOneLineError(run({}), {"--help"});
  expectOneLineError(run({"feeel", box}), {"feeel"});
  expectOneLineError(run({"feel", box, "-o", out}), {"--path", "missing"});
  expectOneLineError(run({"feel", "--path", path, "-o", out}), {"MESH", "missing"});
  expectOneLineError(run({"field", box, "-o", folder / "f.vti", "--voxel", "3 parsec"}),
                     {"--voxel", "parsec"});
  expectOneLineError(run({"field", box, "-o", folder / "f.vti", "--voxel", "-1mm"}), {"voxel"});
  expectOneLineError(run({"field", box, "-o", folder / "f.vti", "--voxel", "1nm"}), {});
  expectOneLineError(run({"field", box, "-o", folder / "f.vti", "--resolution", "12"}),
                     {"resolution"});
  expectOneLineError(run({"field", box, "-o", folder / "f.vti", "--resolution", "150.5"}),
                     {"--resolution", "150.5"});
  expectOneLineError(run({"feel", box, "--path", path, "-o", out, "--sampler", "best"}),
                     {"--sampler", "kim", "high"});
  expectOneLineError(run({"info", box, "--unit", "yard"}), {"--unit", "yard", "mm"});
  expectOneLineError(run({"feel", box, "--path", path, "-o", out, "--friction-static", "0.2",
                          "--friction-dynamic", "0.4"}),
                     {"friction.dynamic"});
  expectOneLineError(run({"feel", box, "--path", path, "-o", out, "--stiffness", "1,5"}),
                     {"--stiffness", "1,5"});
  expectOneLineError(run({"model", "teapot", "-o", folder / "t.ply"}), {"teapot", "dinosaur"});
  expectOneLineError(run({"model", "box", "-o", folder / "t.ply", "--tube", "1mm"}),
                     {"--tube", "--width"});
  expectOneLineError(run({"model", "sphere", "-o", folder / "t.ply", "--radius", "0"}),
                     {"--radius"});
  expectOneLineError(run({"latency-test", "--seconds", "0"}), {"--seconds"});
  expectOneLineError(run({"render", box, "-o", folder / "p.png", "--show", "smell"}),
                     {"--show", "smell", "mesh"});
  expectOneLineError(run({"render", box, "-o", folder / "p.png", "--view", "+w"}), {"--view"});
  expectOneLineError(run({"render", box, "-o", folder / "p.png", "--size", "9x9"}), {"--size"});
  expectOneLineError(run({"render", box, "-o", folder / "p.png", "--show", "tip"}), {"--tip"});
  expectOneLineError(run({"render", box, "-o", folder / "p.png", "--show", "mesh,band"}),
                     {"band", "offset", "magnet"});
}

TEST_F(BadInput, NamesUnknownOptionsAndSurplusInputs) {
  expectOneLineError(run({"feel", box, "--path", path, "-o", out, "--banana", "1mm"}),
                     {"unknown option --banana; see patina feel --help"});
  expectOneLineError(run({"info", box, "--offset=1mm"}), {"unknown option --offset;"});
  expectOneLineError(run({"info", box, "-q"}), {"unknown option -q;"});
  expectOneLineError(run({"info", box, "b"}), {"one FILE at a time: 'b' is one too many"});
  expectOneLineError(run({"latency-test", "b"}), {"'b' is one word too many"});
  expectOneLineError(run({"devices", "b"}), {"'b' is a folder for --install-udev alone"});
  // A value may look like an option or an input, and may be attached to its option.
  EXPECT_EQ(run({"info", "--voxel=1mm", box}).exit, 0);
  EXPECT_EQ(run({"feel", "--path", path, box, "-o" + out}).exit, 0);
  expectOneLineError(run({"render", box, "-o", folder / "p.png", "--view", "-w"}), {"--view"});
}

// An unset shell variable gives such a word.
TEST_F(BadInput, EmptyWordIsNoValue) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"model", "sphere", "-o", ""},
                                             {"model", "sphere", "--output="},
                                             {"info", box, "--unit", ""}})
    expectOneLineError(run(words), {"'' is no value; see patina " + words.front() + " --help"});
  expectOneLineError(run({"info", ""}), {"FILE: '' is no value"});
}

TEST_F(BadInput, SuggestsCorrectionsForMistypedWords) {
  const auto line = [](const std::vector<std::string>& words) {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit, 2);
    return outcome.err;
  };
  EXPECT_EQ(line({"inf", "x"}), "patina: unknown command 'inf'; did you mean 'info'?\n");
  EXPECT_EQ(line({"smaple"}), "patina: unknown command 'smaple'; did you mean 'sample'?\n");
  EXPECT_EQ(line({"xyzzy"}), "patina: unknown command 'xyzzy'; see patina --help\n");
  EXPECT_EQ(line({"info", box, "--resoluton", "40"}),
            "patina: unknown option --resoluton; did you mean '--resolution'?\n");
  EXPECT_EQ(line({"info", box, "--jsn"}), "patina: unknown option --jsn; did you mean '--json'?\n");
  expectOneLineError(run({"study", "fied", "-o", folder / "s"}),
                     {"unknown study 'fied'; did you mean 'field'?", "friction", "all"});
  expectOneLineError(run({"model", "spere", "-o", folder / "s.ply"}),
                     {"unknown model 'spere'; did you mean 'sphere'?", "galleon"});
}

TEST_F(BadInput, WarnsOfOptionsOfAnotherMode) {
  const auto warned = [&](const std::vector<std::string>& words, const std::string& line) {
    const Outcome outcome = run(words);
    EXPECT_NE(outcome.err.find("warning: " + line), std::string::npos) << outcome.err;
  };
  warned({"latency-test", "--seconds", "0.01", "--load", "3"},
         "--load has no effect without --emulated-falcon");
  warned({"latency-test", "--seconds", "0.01", "--emulated-falcon", "--rate", "500"},
         "--rate has no effect with --emulated-falcon");
  warned({"simulate", "--plane", "--seconds", "3", "--voxel", "1mm"},
         "--voxel has no effect with --plane");
  warned({"simulate-scan", box, "-o", folder / "poses", "--seconds", "1", "--blur", "2"},
         "--blur has no effect without --frames");
  const std::string filmed = folder / "filmed";
  warned({"simulate-scan", box, "-o", filmed, "--seconds", "1", "--frames", "--outliers", "0.1"},
         "--outliers has no effect with --frames");
  warned({"track", filmed, "-o", folder / "poses.tum", "--rate", "20"},
         "--rate has no effect beside frames.csv");
  warned({"fit-texture", box, "-o", folder / "t.json", "--seed", "7"},
         "--seed has no effect without --kind spectrum");
}

TEST_F(BadInput, VoxelOptionCountsInAnyOrder) {
  const Json first = runJson({"info", box, "--voxel", "2mm", "--resolution", "60"}),
             last = runJson({"info", box, "--resolution", "60", "--voxel", "2mm"});
  EXPECT_DOUBLE_EQ(first.at("field").at("voxel").asNumber(), 2e-3);
  EXPECT_DOUBLE_EQ(last.at("field").at("voxel").asNumber(), 2e-3);
}

TEST_F(BadInput, RefusesVolumesWithoutOriginOrSpacing) {
  const auto volume = [&](const std::string& origin, const std::string& spacing) {
    std::string values;
    for (int i = 0; i < 27; ++i) values += i == 13 ? "-1 " : "1 ";
    return folder.write("v.vti",
                        "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\">"
                        "<ImageData WholeExtent=\"0 2 0 2 0 2\" Origin=\"" +
                            origin + "\" Spacing=\"" + spacing +
                            "\"><Piece Extent=\"0 2 0 2 0 2\"><PointData Scalars=\"a\">"
                            "<DataArray type=\"Float32\" Name=\"a\" format=\"ascii\">" +
                            values + "</DataArray></PointData></Piece></ImageData></VTKFile>\n");
  };
  EXPECT_EQ(run({"info", volume("0 0 0", "10 10 10"), "--iso", "0"}).exit, 0);
  for (const char* spacing : {"abc 10 10", "nan 10 10", "0 10 10", "-10 10 10", "10 10"})
    expectOneLineError(run({"info", volume("0 0 0", spacing), "--iso", "0"}), {"v.vti", "Spacing"});
  expectOneLineError(run({"info", volume("nan 0 0", "1 1 1"), "--iso", "0"}), {"v.vti", "Origin"});
  const std::string other = volume("0 0 0", "nan 1 1"), text = readFile(other);
  folder.write("v.vti", std::string(text).replace(text.find(" Spacing=\"nan 1 1\""), 18,
                                                  "\n\tSpacing='nan 1 1'"));
  expectOneLineError(run({"info", other, "--iso", "0"}), {"v.vti", "Spacing"});
}

TEST_F(BadInput, BytesThatMoveTheCursorDoNotReachTheTerminal) {
  const std::string pose = folder.write("e.txt", "1 0 \x1b[31mX\xC2\x9B 0\n");
  const Outcome outcome = run({"scene", "-o", folder / "w", "--add", box + "@" + pose});
  expectOneLineError(outcome, {"e.txt:1", "?[31mX??"});
  EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos);
}

TEST_F(BadInput, RefusesModelsThatNoFileCanHold) {
  for (const char* radius : {"1e308", "1e-320", "-1", "inf"})
    expectOneLineError(run({"model", "sphere", "-o", folder / "b.ply", "--radius", radius}),
                       {"--radius", radius});
  EXPECT_FALSE(std::filesystem::exists(folder / "b.ply"));
}

TEST_F(BadInput, NamesOptionsWithoutAValueAndFlagsWithOne) {
  expectOneLineError(run({"info", box, "--voxel"}), {"--voxel", "LENGTH is missing"});
  expectOneLineError(run({"info", box, "--json=yes"}), {"--json takes no value"});
  // After "--" everything is an input.
  expectOneLineError(run({"info", "--", "--voxel"}), {"--voxel: no such"});
}

TEST_F(BadInput, CountsNonFiniteTipsAndPointsAndWarns) {
  const std::string tips = folder.write(
      "bad.csv", "t [s],x [m],y [m],z [m]\n0,0,0,0.1\n1,nan,0,0\n2,0,inf,0\n3,-nan,0,0\n");
  const Outcome felt = run({"feel", box, "--path", tips, "-o", out, "--json"});
  ASSERT_EQ(felt.exit, 0) << felt.err;
  EXPECT_EQ(parseJson(felt.out, "stdout").at("bad_tips").asInteger(), 3);
  EXPECT_NE(felt.err.find("bad.csv: 3 tips"), std::string::npos) << felt.err;
  EXPECT_EQ(readFile(out).find("-nan"), std::string::npos);
  const std::string points =
      folder.write("bad.csv", "x [m],y [m],z [m]\n0,0,0.1\nnan,0,0\n0,inf,0\n-nan,0,0\n");
  const std::string field = folder / "box.VTI";
  ASSERT_EQ(run({"field", box, "-o", field, "--resolution", "40"}).exit, 0);
  for (const std::string& input : {box, field}) {
    const Outcome sampled = run({"sample", input, "--points", points, "-o", out, "--json"});
    ASSERT_EQ(sampled.exit, 0) << sampled.err;
    EXPECT_EQ(parseJson(sampled.out, "stdout").at("bad_points").asInteger(), 3);
    EXPECT_NE(sampled.err.find("bad.csv: 3 points"), std::string::npos) << sampled.err;
    EXPECT_NE(readFile(out).find("nan"), std::string::npos);
    EXPECT_EQ(readFile(out).find("-nan"), std::string::npos);
  }
}

TEST_F(BadInput, NamesTheFaultOfAFieldFile) {
  const std::string field = folder / "box.vti";
  ASSERT_EQ(run({"field", box, "-o", field, "--resolution", "40"}).exit, 0);
  expectOneLineError(run({"info", field, "--iso", "5"}), {"box.vti", "--iso 5", "between -0.0"});
  const std::string bytes = readFile(field);
  const std::string half = folder.write("half.vti", bytes.substr(0, bytes.size() / 2));
  expectOneLineError(run({"info", half}), {"half.vti", "truncated or damaged"});
  const Outcome useless = run({"info", field, "--unit", "cm", "--resolution", "60"});
  EXPECT_EQ(useless.exit, 0);
  EXPECT_NE(useless.err.find("--unit has no effect on a field"), std::string::npos) << useless.err;
  EXPECT_NE(useless.err.find("--resolution has no effect"), std::string::npos) << useless.err;
  EXPECT_NE(
      run({"info", box, "--no-field", "--iso", "1"}).err.find("--iso has no effect on a mesh"),
      std::string::npos);
}

TEST_F(BadInput, GivesTheRemedyForTooFineGrids) {
  const std::string field = folder / "f.vti";
  expectOneLineError(run({"field", box, "-o", field, "--voxel", "1e-9"}),
                     {"choose a larger voxel or --unit"});
  // The scene's limit is the grid's own.
  expectOneLineError(run({"field", box, "-o", field, "--resolution", "4096"}),
                     {"--resolution", "between 8 and 4095"});
}

TEST_F(BadInput, LeavesOutNonFiniteVerticesAndWarns) {
  std::string text = readFile(box) + "v nan 0 0\nv 1 inf 0\n";
  const std::size_t n = static_cast<std::size_t>(std::count(text.begin(), text.end(), 'v'));
  text += "f 1 2 " + std::to_string(n) + "\nf 1 2 " + std::to_string(n - 1) + "\n";
  const std::string mesh = folder.write("nan.obj", text);
  for (const char* unit : {"mm", "fit"}) {
    const Outcome info = run({"info", mesh, "--json", "--resolution", "40", "--unit", unit});
    ASSERT_EQ(info.exit, 0) << info.err;
    EXPECT_NE(info.err.find("warning"), std::string::npos);
    EXPECT_NE(info.err.find("2 triangles"), std::string::npos) << info.err;
    const Json json = parseJson(info.out, "stdout");
    EXPECT_EQ(json.at("defects").at("non_finite").asInteger(), 2);
    EXPECT_EQ(json.at("field").at("dropped_triangles").asInteger(), 2);
  }
  const std::string only = folder.write("only.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expectOneLineError(run({"info", only}), {"only.obj", "no usable triangle", "1 with a NaN"});
  expectOneLineError(run({"render", only, "-o", folder / "p.png"}),
                     {"only.obj", "no usable triangle"});
  ASSERT_EQ(run({"scene", "-o", folder / "bare"}).exit, 0);
  expectOneLineError(run({"render", folder / "bare", "-o", folder / "p.png"}), {"no object"});
  EXPECT_FALSE(std::filesystem::exists(folder / "p.png"));
}

TEST_F(BadInput, ForeignVolumesNeedAnIsoValue) {
  const std::string volume = folder.write(
      "volume.vti",
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<ImageData WholeExtent=\"0 3 0 3 0 3\" Origin=\"0 0 0\" "
      "Spacing=\"10 10 10\">\n<Piece Extent=\"0 3 0 3 0 3\">\n<PointData Scalars=\"density\">\n"
      "<DataArray type=\"Float32\" Name=\"density\" format=\"ascii\">\n" +
          [] {
            std::string values;
            for (int i = 0; i < 64; ++i) {
              const bool inner = i % 4 % 3 && i / 4 % 4 % 3 && i / 16 % 3;
              values += inner ? "100 " : "0 ";
            }
            return values;
          }() +
          "\n</DataArray>\n</PointData>\n</Piece>\n</ImageData>\n</VTKFile>\n");
  expectOneLineError(run({"info", volume}), {"volume.vti", "--iso", "between 0 and 100"});
  const Json info = runJson({"info", volume, "--iso", "50", "--resolution", "40"});
  EXPECT_TRUE(info.at("watertight").asBool());
  EXPECT_NEAR(info.at("bounds").asArray()[0].asArray()[0].asNumber(), 0.005, 1e-6); // 5 mm
  expectOneLineError(run({"info", volume, "--iso", "500"}), {"volume.vti"});
}

} // namespace
} // namespace patina::test
