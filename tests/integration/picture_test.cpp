// Commands that draw: with a display, and the advice if it is missing.
#include <gtest/gtest.h>

#include "core/file.h"
#include "integration/program.h"
#include "support/own_display.h"

namespace patina::test {
namespace {

Outcome runWithoutDisplay(std::vector<std::string> words) {
  std::vector<std::string> all = {"-u", "DISPLAY", programPath().string()};
  all.insert(all.end(), words.begin(), words.end());
  return Running(all, "env").wait();
}

std::uint32_t bigEndian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

TEST(Pictures, GiveAdviceWithoutADisplay) {
  const ScratchFolder folder;
  const std::string box = folder / "box.ply";
  ASSERT_EQ(run({"model", "box", "-o", box}).exit, 0);
  expectOneLineError(runWithoutDisplay({"render", box, "-o", folder / "p.png"}), {"xvfb-run"});
  EXPECT_FALSE(std::filesystem::exists(folder / "p.png"));
}

TEST(Pictures, AreDrawnInTheRequestedSize) {
  if (!hasDisplay()) GTEST_SKIP() << "neither Xvfb nor DISPLAY";
  const ScratchFolder folder;
  const std::string box = folder / "box.ply";
  ASSERT_EQ(run({"model", "box", "-o", box}).exit, 0);
  const Outcome outcome =
      run({"render", box, "-o", folder / "p.png", "--show", "mesh,slice,tip", "--tip", "0,0,19mm",
           "--view", "+x", "--size", "320x200", "--resolution", "50"});
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  const std::string png = readFile(folder / "p.png");
  ASSERT_GT(png.size(), 1000u);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(bigEndian(png, 16), 320u);
  EXPECT_EQ(bigEndian(png, 20), 200u);
}

TEST(Pictures, OfAWidthOnPaperHaveItsPixelsAndResolution) {
  if (!hasDisplay()) GTEST_SKIP() << "neither Xvfb nor DISPLAY";
  const ScratchFolder folder;
  const std::string box = folder / "box.ply";
  ASSERT_EQ(run({"model", "box", "-o", box}).exit, 0);
  const Json report =
      runJson({"render", box, "-o", folder / "p.png", "--width", "85mm", "--dpi", "300",
               "--background", "transparent", "--without", "cube,legend", "--show", "mesh,slice",
               "--slice", "0,1,1:5mm", "--resolution", "50"});
  EXPECT_EQ(report.at("width").asNumber(), 1004);
  EXPECT_EQ(report.at("dpi").asNumber(), 300);
  const std::string png = readFile(folder / "p.png");
  EXPECT_EQ(bigEndian(png, 16), 1004u);
  EXPECT_EQ(png[25], 6) << "red, green, blue, alpha";
  ASSERT_NE(png.find("pHYs"), png.npos);
  EXPECT_EQ(bigEndian(png, png.find("pHYs") + 4), 11811u) << "pixels per metre";
  ASSERT_EQ(run({"render", box, "-o", folder / "p.tif", "--scale", "2", "--size", "64x48"}).exit,
            0);
  EXPECT_EQ(readFile(folder / "p.tif").substr(0, 4), std::string("II*\0", 4));
  for (const char* name : {"p.svg", "p.pdf"}) // the second time over a file of its own kind
    for (int i = 0; i < 2; ++i) {
      const Outcome drawn = run({"render", box, "-o", folder / name, "--size", "64x48"});
      EXPECT_EQ(drawn.exit, 0) << drawn.err;
    }
  EXPECT_EQ(readFile(folder / "p.pdf").substr(0, 4), "%PDF");
}

TEST(Pictures, HaveTheSlicesOfTheWorkspaceUnlessOthersAreNamed) {
  if (!hasDisplay()) GTEST_SKIP() << "neither Xvfb nor DISPLAY";
  const ScratchFolder folder;
  const std::string box = folder / "box.ply", kept = folder / "kept";
  ASSERT_EQ(run({"model", "box", "-o", box}).exit, 0);
  ASSERT_EQ(
      run({"scene", "-o", kept, "--add", box, "--set", "slice=x:2mm", "--set", "slice3=0,1,1"})
          .exit,
      0);
  const auto drawn = [&](const std::string& scene, const std::vector<std::string>& slices) {
    std::vector<std::string> words = {"render", scene,    "-o",      folder / "p.png", "--show",
                                      "slice",  "--size", "160x120", "--resolution",   "50"};
    for (const std::string& slice : slices) words.insert(words.end(), {"--slice", slice});
    std::filesystem::remove(folder / "p.png");
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    return readFile(folder / "p.png");
  };
  EXPECT_EQ(drawn(kept, {}), drawn(box, {"x:2mm", "0,1,1"}));
  EXPECT_EQ(drawn(kept, {"y"}), drawn(box, {}));
  EXPECT_NE(drawn(kept, {}), drawn(kept, {"x:2mm"}));
}

TEST(Pictures, NameTheChoicesForWhatIsNone) {
  const ScratchFolder folder;
  const std::string box = folder / "box.ply", out = folder / "p.png";
  ASSERT_EQ(run({"model", "box", "-o", box}).exit, 0);
  const auto refused = [&](std::vector<std::string> words, const std::string& cause) {
    std::vector<std::string> all = {"render", box, "-o", out};
    all.insert(all.end(), words.begin(), words.end());
    expectOneLineError(run(all), {cause});
  };
  refused({"--background", "pink"}, "transparent");
  refused({"--without", "mesh"}, "legend");
  refused({"--width", "9000mm"}, "16384");
  refused({"--width", "12.5"}, "85mm");
  refused({"--slice", "w"}, "0,1,1");
  refused({"--slice", "x:1mm"}, "--show");
  refused({"--show", "slice", "--slice", "x", "--slice", "y", "--slice", "z", "--slice", "0,1,1"},
          "three");
  EXPECT_FALSE(std::filesystem::exists(out));
}

} // namespace
} // namespace patina::test
