// Commands that draw: with a display, or with the word of advice that one is missing.
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

TEST(Pictures, SayWhatToDoWithoutADisplay) {
  const ScratchFolder folder;
  const std::string box = folder / "box.ply";
  ASSERT_EQ(run({"model", "box", "-o", box}).exit, 0);
  expectOneLineError(runWithoutDisplay({"render", box, "-o", folder / "p.png"}), {"xvfb-run"});
  EXPECT_FALSE(std::filesystem::exists(folder / "p.png"));
}

TEST(Pictures, AreDrawnInTheAskedSize) {
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

} // namespace
} // namespace patina::test
