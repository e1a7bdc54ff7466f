// One report a command: --json contains the values that --help lists and that are printed.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <sys/stat.h>

#include "core/csv.h"
#include "core/numbers.h"
#include "core/sha256.h"
#include "core/version.h"
#include "integration/program.h"
#include "session/store/attach_scan.h"

namespace patina::test {
namespace {

std::set<std::string> keysInHelp(const std::string& command) {
  std::istringstream help(run({command, "--help"}).out);
  std::set<std::string> keys;
  bool in_list = false;
  for (std::string line; std::getline(help, line);) {
    if (line == "Keys of --json:")
      in_list = true;
    else if (line.empty())
      in_list = false;
    else if (in_list && line[2] != ' ')
      keys.insert(line.substr(2, line.find(' ', 2) - 2));
  }
  return keys;
}

class Reports : public testing::Test {
 protected:
  void SetUp() override {
    box = folder / "box.ply";
    ASSERT_EQ(run({"model", "box", "-o", box}).exit, 0);
    scene = folder / "scene";
    ASSERT_EQ(run({"scene", "-o", scene, "--add", box, "--set", "device.mass=0.1", "--set",
                   "resolution=40"})
                  .exit,
              0);
    tips = folder.write("tip.csv", "t [s],x [m],y [m],z [m]\n0,0,0,0.03\n0.001,0,0,0.019\n");
  }
  ScratchFolder folder;
  std::string box, scene, tips;
};

TEST_F(Reports, HaveOnlyKeysOfTheirCommandsHelp) {
  std::vector<std::vector<std::string>> calls = {
      {"model", "box", "-o", folder / "b.ply"},
      {"scene", "-o", scene},
      {"info", scene},
      {"info", box, "--no-field"},
      {"field", scene, "-o", folder / "f.vti"},
      {"sample", scene, "--points", tips, "-o", folder / "s.csv"},
      {"feel", scene, "--path", tips, "-o", folder / "f.csv"},
      {"simulate", "--plane", "--seconds", "3"},
      {"undo", scene},
      {"redo", scene, "--list"},
      {"emboss", scene, "-o", folder / "e.ply"},
      {"export", scene, "-o", folder / "out", "--stability"},
      {"devices"},
      {"latency-test", "--seconds", "0.1"},
      {"latency-test", "--emulated-falcon", "--seconds", "0.3", "--faults", "20"}};
  const std::string scan = folder / "scan";
  calls.push_back({"simulate-scan", box, "-o", scan, "--dropouts", "2"});
  calls.push_back({"filter", scan, "-o", folder / "path.csv"});
  const std::string seen = folder / "seen";
  calls.push_back({"simulate-scan", box, "-o", seen, "--frames", "--seconds", "1"});
  calls.push_back({"track", seen, "-o", folder / "poses.tum"});
  for (const std::vector<std::string>& call : calls) {
    const Json report = runJson(call);
    const std::set<std::string> known = keysInHelp(call.front());
    EXPECT_FALSE(report.asObject().empty()) << call.front();
    for (const auto& [key, value] : report.asObject())
      EXPECT_TRUE(known.contains(key)) << call.front() << ": " << key;
  }
}

TEST_F(Reports, NameTheProgramThatMadeThem) {
  for (const auto& call : {std::vector<std::string>{"info", box, "--no-field"}, {"devices"}}) {
    const Json program = runJson(call).at("program");
    EXPECT_EQ(program.at("version").asString(), programVersion());
    EXPECT_EQ(program.at("commit").asString(), programCommit());
  }
}

// Returns the paths of a report's inputs, after comparing each hash with the file's.
std::vector<std::string> pathsOf(const Json& report) {
  std::vector<std::string> paths;
  for (const Json& input : report.at("inputs").asArray()) {
    const std::string path = input.at("path").asString();
    EXPECT_EQ(input.at("sha256").asString(), sha256OfFile(path)) << path;
    paths.push_back(path);
  }
  return paths;
}

TEST_F(Reports, ContainTheHashesOfTheReadFiles) {
  using Paths = std::vector<std::string>;
  EXPECT_EQ(pathsOf(runJson({"info", box, "--no-field"})), Paths{box});
  EXPECT_EQ(pathsOf(runJson({"feel", box, "-o", folder / "f.csv", "--path", tips})),
            (Paths{box, tips}));
  EXPECT_TRUE(pathsOf(runJson({"model", "box", "-o", folder / "b.ply"})).empty());
  const std::string pose = folder.write("pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 1\n0 0 0 1\n");
  EXPECT_EQ(pathsOf(runJson({"scene", "-o", folder / "new", "--add", box + "@" + pose})),
            (Paths{box, pose}));
  EXPECT_EQ(pathsOf(runJson({"info", scene, "--no-field"})),
            (Paths{scene + "/workspace.json", scene + "/journal-1.jsonl"}));
}

TEST_F(Reports, ContainTheHashesOfAWorkspaceBeforeItsEdit) {
  const std::string before = sha256OfFile(scene + "/workspace.json");
  const Json report = runJson({"scene", "-o", scene, "--set", "stiffness=700"});
  const Json& first = report.at("inputs").asArray().at(0);
  EXPECT_EQ(first.at("path").asString(), scene + "/workspace.json");
  EXPECT_EQ(first.at("sha256").asString(), before);
  EXPECT_NE(sha256OfFile(scene + "/workspace.json"), before);
}

TEST_F(Reports, MarkInputsThatAreNoFilesAsWithoutHash) {
  const std::string fifo = folder / "fifo";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  Running reader({"sample", box, "--points", fifo, "-o", folder / "s.csv", "--json"},
                 programPath());
  std::ofstream(fifo) << "x [m],y [m],z [m]\n0,0,0.03\n";
  const Outcome outcome = reader.wait();
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  const Json inputs = parseJson(outcome.out, "report").at("inputs");
  EXPECT_EQ(inputs.asArray().at(1).at("path").asString(), fifo);
  EXPECT_TRUE(inputs.asArray().at(1).at("sha256").isNull());
}

TEST_F(Reports, ContainEachFileOfAScanFolderAndADigestOfItsFrames) {
  const std::string seen = folder / "seen";
  ASSERT_EQ(run({"simulate-scan", box, "-o", seen, "--frames", "--seconds", "1"}).exit, 0);
  const Json tracked = runJson({"track", "replay:" + seen, "-o", folder / "poses.tum"});
  std::vector<std::string> names;
  for (const Json& input : tracked.at("inputs").asArray()) {
    const std::filesystem::path path = input.at("path").asString();
    names.push_back(path.filename());
    if (names.back() == "frames")
      EXPECT_EQ(input.at("digest").asString(), framesDigest(seen));
    else
      EXPECT_EQ(input.at("sha256").asString(), sha256OfFile(path)) << path;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"frames.csv", "probe.csv", "truth.json", "camera.yml",
                                             "rig.json", "frames"}));
}

TEST_F(Reports, SumUpTheMemoryInInfo) {
  const std::string two = folder / "two";
  ASSERT_EQ(run({"scene", "-o", two, "--add", box, "--add", box, "--set", "resolution=40"}).exit,
            0);
  for (const std::string& input : {scene, two}) {
    const Json info = runJson({"info", input});
    std::int64_t sum = 0;
    for (const Json& layer : info.at("layers").asArray()) sum += layer.at("bytes").asInteger();
    EXPECT_EQ(info.at("bytes").asInteger(), sum);
    EXPECT_GT(sum, info.at("field").at("bytes").asInteger());
    const std::string text = run({"info", input}).out;
    const std::size_t at = text.find("\nin all ");
    ASSERT_NE(at, std::string::npos) << text;
    EXPECT_NE(text.find(formatBytes(static_cast<double>(sum)), at), std::string::npos) << text;
  }
  EXPECT_EQ(runJson({"info", box, "--no-field"}).find("bytes"), nullptr);
}

// The path given to feel is sampled at the same positions as the points themselves.
TEST_F(Reports, AreTheSameForAPathAndItsPointsInSample) {
  const std::string points = folder.write("points.csv", "x [m],y [m],z [m]\n0,0,0.03\n0,0,0.019\n");
  const std::string of_path = folder / "path.csv", of_points = folder / "samples.csv";
  const Json path = runJson({"sample", scene, "--points", tips, "-o", of_path});
  EXPECT_EQ(path.at("points").asInteger(), 2);
  ASSERT_EQ(run({"sample", scene, "--points", points, "-o", of_points}).exit, 0);
  const std::vector<std::string> columns = {"x [m]", "y [m]", "z [m]", "phi [m]"};
  EXPECT_EQ(readCsv(of_path, columns).rows, readCsv(of_points, columns).rows);
}

TEST_F(Reports, NameTheAllowedHeadersOfPointsInSample) {
  const std::string out = folder / "o.csv";
  const auto refused = [&](const char* text, const char* reason) {
    expectOneLineError(run({"sample", scene, "--points", folder.write("bad.csv", text), "-o", out}),
                       {"bad.csv", reason});
  };
  refused("", "x [m],y [m],z [m]");
  refused("t [s],x [m]\n0,0\n", "it lacks 'y [m]'");
  refused("x,y,z\n0,0,0\n", "has no unit");
  expectOneLineError(
      run({"sample", scene, "--points",
           folder.write("bad.csv", "t [s],x [m],y [m],z [m]\n0,0,0,0\n1,0,oops,0\n"), "-o", out}),
      {"bad.csv:3:", "oops"});
  EXPECT_FALSE(std::filesystem::exists(out));
}

} // namespace
} // namespace patina::test
