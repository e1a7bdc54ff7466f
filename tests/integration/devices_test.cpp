// What the devices' commands do to a machine without any: rules that are written where they are
// asked for, and a probe that is not there.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "core/file.h"
#include "integration/program.h"
#ifdef PATINA_HAS_ACQUISITION
#include "acquisition/sources/sources.h"
#endif

namespace patina::test {
namespace {

TEST(DevicesCommand, WritesTheRulesOfUdevWhereItIsTold) {
  const ScratchFolder folder;
  const Json report = runJson({"devices", "--install-udev", folder.path().string()});
  const std::string file = folder / "70-patina.rules";
  EXPECT_EQ(report.at("rules").asString(), file);
  EXPECT_NE(readFile(file).find("ATTR{idVendor}==\"0403\", ATTR{idProduct}==\"cb48\""),
            std::string::npos);
  expectOneLineError(run({"devices", "--install-udev", folder / "no/such"}),
                     {"70-patina.rules", "run this as root (sudo), or name a folder of your own"});
}

#ifdef PATINA_HAS_ACQUISITION
TEST(SimulatedProbe, IsReadFromItsPortWithNothingLostOnTheWay) {
  const ScratchFolder folder;
  const std::string link = folder / "probe";
  Running probe({"simulate-device", "probe", "--rate", "2000", "--loss", "0.05", "--seconds", "2",
                 "--link", link, "--json"},
                programPath());
  for (int i = 0; i < 5000 && !std::filesystem::exists(link); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const auto source = openProbe("serial:" + link);
  std::vector<ProbeSample> samples;
  while (samples.size() < 2000) ASSERT_TRUE(source->read(samples));
  const ProbeHealth health = source->health().value();
  EXPECT_EQ(samples.size(), 4 * health.packets);
  EXPECT_GT(health.lost_packets, 0u);
  EXPECT_EQ(health.corrupt + health.repeated, 0u);
  const Outcome outcome = probe.wait();
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(link)));
  const Json report = parseJson(outcome.out, "report");
  EXPECT_EQ(report.at("unread").asInteger(), 0);
  EXPECT_GE(report.at("lost").asInteger(), static_cast<std::int64_t>(health.lost_packets));
}

TEST(SimulatedProbe, ThatIsNotThereIsOneLine) {
  const ScratchFolder folder;
  expectOneLineError(run({"simulate-device", "telephone"}),
                     {"it must be falcon, spacemouse or probe"});
}
#endif

} // namespace
} // namespace patina::test
