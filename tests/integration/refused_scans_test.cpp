// Scans that are damaged, empty or mixed with another one cause one line of error, and nothing is
// written.
#include "integration/scans.h"

namespace patina::test {
namespace {

TEST_F(Scans, AreRefusedWithFileAndLineIfDamaged) {
  simulate();
  const std::string poses = readFile(scan + "/poses.tum"), probe = readFile(scan + "/probe.csv");
  const std::string head = probe.substr(0, probe.find('\n') + 1);
  refused("poses.tum", "", {"poses.tum", "no pose"});
  refused("poses.tum", poses + "0 0 0 0 0 0 0 1\n", {"poses.tum:", "backwards"});
  refused("poses.tum", "0 0,5 0 0 0 0 0 1\n", {"poses.tum:1:", "decimal commas"});
  refused("poses.tum", "0 nan 0 0 0 0 0 1\n", {"poses.tum:1:", "tx [m] is not a finite number"});
  refused("poses.tum", "1000 0 0 0 0 0 0 1\n1001 0 0 0 0 0 0 1\n", {"no time in common"});
  refused("probe.csv", "", {"probe.csv", "empty"});
  refused("probe.csv", head, {"probe.csv", "no sample"});
  refused("probe.csv", probe + "0,0,0,0,0,0\n", {"probe.csv:", "backwards"});
  refused("probe.csv", head + "0,0,0,nan,0,0\n", {"probe.csv:2:", "a1v"});
  refused("probe.csv", head + "0,1;0;0;0;0;0\n", {"probe.csv:2:", "decimal commas"});
  refused("rig.json", "{", {"rig.json"});
  refused("rig.json", "{\"tip\": 3}", {"rig.json", "tip"});
  refused("rig.json", "{\"tip\": [0, 0, -1e9]}", {"rig.json", "'tip' is more than 10 m away"});
  const std::string rig = readFile(scan + "/rig.json");
  const std::size_t gravity = rig.find("\"gravity\"");
  ASSERT_NE(gravity, std::string::npos);
  refused("rig.json",
          rig.substr(0, gravity) + "\"gravity\": [0, 0, -1]" +
              rig.substr(rig.find(']', gravity) + 1),
          {"rig.json", "'gravity' has length 1 m/s^2"});
  std::filesystem::remove(scan + "/poses.tum");
  expectOneLineError(run({"filter", scan, "-o", path}), {"poses.tum"});
  expectOneLineError(run({"filter", folder / "none.tum", "-o", path}), {"none.tum"});
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(Scans, NameTheLineOfAValueThatNothingMeasures) {
  const std::string out = folder / "out.csv";
  const std::string head = "t [s],x [m],y [m],z [m],qx,qy,qz,qw,sigma [m],force [N]\n",
                    good = "0,0,0,.05,0,0,0,1,1e-4,1\n";
  for (const char* row : {"1,0,0,.05,0,0,0,2,1e-4,1\n", "1,0,0,.05,0,0,0,1,-1e-4,1\n",
                          "1,0,0,1e300,0,0,0,1,1e-4,1\n", "1,nan,0,.05,0,0,0,1,1e-4,1\n"}) {
    writeFileAtomically(path, head + good + row);
    expectOneLineError(run({"register", ball, path, "-o", out}), {"path.csv:3:"});
    EXPECT_FALSE(std::filesystem::exists(out)) << row;
  }
  const std::string heights = folder / "heights.csv", texture = folder / "texture.json";
  for (const char* row : {"1,.1,nan,1e-5,0\n", "1,.1,1e300,1e-5,0\n"}) {
    writeFileAtomically(heights, "t [s],along [m],height [m],sigma [m],stretch\n0,0,0,1e-5,0\n" +
                                     std::string(row));
    expectOneLineError(run({"fit-texture", heights, "-o", texture}), {"heights.csv:3:", "height"});
    EXPECT_FALSE(std::filesystem::exists(texture)) << row;
  }
}

TEST_F(Scans, AreNotMixedWithAnotherScan) {
  const auto again = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"simulate-scan", ball, "-o", scan, "--seconds", "1"});
    return run(more);
  };
  simulate();
  EXPECT_EQ(again({"--seed", "3"}).exit, 0) << "another scan of the same files replaces it";
  const std::string kept = readFile(scan + "/rig.json");
  expectOneLineError(again({"--frames"}), {scan, "holds a scan already: name another folder"});
  std::filesystem::remove(scan + "/truth.json"); // like a recorded scan
  expectOneLineError(again({}), {scan, "holds a scan already"});
  EXPECT_EQ(readFile(scan + "/rig.json"), kept);
  expectOneLineError(run({"simulate-scan", ball, "-o", "-"}), {"a scan is a folder"});
}

TEST_F(Scans, AreRefusedWithoutASurface) {
  const std::string plate = folder.write("wall.obj", "v 0 0 0\nv 100 0 0\nv 0 0.1 100\nf 1 2 3\n");
  expectOneLineError(run({"simulate-scan", plate, "-o", scan}), {"--from"});
  EXPECT_FALSE(std::filesystem::exists(scan));
  expectOneLineError(run({"simulate-scan", ball, "-o", scan, "--from", "up"}), {"--from", "up"});
}

} // namespace
} // namespace patina::test
