// One report a command: what --json holds is what --help lists and what people read.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "core/csv.h"
#include "core/numbers.h"
#include "integration/program.h"

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

TEST_F(Reports, HaveNoKeyThatTheHelpOfTheirCommandLacks) {
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
      {"latency-test", "--wire", "--seconds", "0.3", "--faults", "20"}};
#ifdef PATINA_HAS_ACQUISITION
  const std::string scan = folder / "scan";
  calls.push_back({"simulate-scan", box, "-o", scan, "--dropouts", "2"});
  calls.push_back({"filter", scan, "-o", folder / "path.csv"});
  const std::string seen = folder / "seen";
  calls.push_back({"simulate-scan", box, "-o", seen, "--frames", "--seconds", "1"});
  calls.push_back({"track", seen, "-o", folder / "poses.tum"});
#endif
  for (const std::vector<std::string>& call : calls) {
    const Json report = runJson(call);
    const std::set<std::string> known = keysInHelp(call.front());
    EXPECT_FALSE(report.asObject().empty()) << call.front();
    for (const auto& [key, value] : report.asObject())
      EXPECT_TRUE(known.contains(key)) << call.front() << ": " << key;
  }
}

TEST_F(Reports, OfInfoSumsUpWhatIsHeld) {
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

// What feel takes is sampled at the same places as the points themselves.
TEST_F(Reports, OfSampleAreTheSameForAPathAsForItsPoints) {
  const std::string points = folder.write("points.csv", "x [m],y [m],z [m]\n0,0,0.03\n0,0,0.019\n");
  const std::string of_path = folder / "path.csv", of_points = folder / "samples.csv";
  const Json path = runJson({"sample", scene, "--points", tips, "-o", of_path});
  EXPECT_EQ(path.at("points").asInteger(), 2);
  ASSERT_EQ(run({"sample", scene, "--points", points, "-o", of_points}).exit, 0);
  const std::vector<std::string> columns = {"x [m]", "y [m]", "z [m]", "phi [m]"};
  EXPECT_EQ(readCsv(of_path, columns).rows, readCsv(of_points, columns).rows);
}

TEST_F(Reports, OfSampleNameTheHeadersThatPointsMayHave) {
  const std::string out = folder / "o.csv";
  for (const char* text :
       {"", "t [s],x [m]\n0,0\n", "x,y,z\n0,0,0\n", "y [m],x [m],z [m]\n0,0,0\n"})
    expectOneLineError(run({"sample", scene, "--points", folder.write("bad.csv", text), "-o", out}),
                       {"bad.csv", "x [m],y [m],z [m]", "t [s],x [m],y [m],z [m]"});
  expectOneLineError(
      run({"sample", scene, "--points",
           folder.write("bad.csv", "t [s],x [m],y [m],z [m]\n0,0,0,0\n1,0,oops,0\n"), "-o", out}),
      {"bad.csv:3:", "oops"});
  EXPECT_FALSE(std::filesystem::exists(out));
}

} // namespace
} // namespace patina::test
