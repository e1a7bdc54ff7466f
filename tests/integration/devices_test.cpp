// The commands for devices on a machine without any: rules are written to the requested file, and a
// missing probe is an error.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "acquisition/sources/sources.h"
#include "core/file.h"
#include "integration/program.h"
#include "support/places.h"
#include "usb/usb_bus.h"

namespace patina::test {
namespace {

TEST(DevicesCommand, WritesUdevRulesIntoTheGivenFolder) {
  const ScratchFolder folder;
  const Json report = runJson({"devices", "--install-udev", folder.path().string()});
  const std::string file = folder / "70-patina.rules";
  EXPECT_EQ(report.at("rules").asString(), file);
  EXPECT_NE(readFile(file).find("ATTR{idVendor}==\"0403\", ATTR{idProduct}==\"cb48\""),
            std::string::npos);
  expectOneLineError(run({"devices", "--install-udev", folder / "no/such"}),
                     {"70-patina.rules", "run this as root (sudo), or name a folder of your own"});
}

TEST(DevicesCommand, HelperForRootWritesTheSameRulesAndLoadsNoLibraryOfADevice) {
  const ScratchFolder folder;
  const auto helper = programFolder() / "patina-udev";
  const std::string file = folder / "70-patina.rules";
  const Outcome outcome = Running({folder.path().string()}, helper).wait();
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_EQ(outcome.out, file + "\n");
  EXPECT_EQ(readFile(file), udevRules());
  folder.write("70-patina.rules", "# of somebody\n");
  const Outcome refused = Running({folder.path().string()}, helper).wait();
  EXPECT_EQ(refused.exit, 2);
  EXPECT_EQ(refused.err,
            "patina-udev: " + file + ": holds other rules than Patina's; remove it first\n");
  EXPECT_EQ(Running({"--help"}, helper).wait().exit, 2);
  const Environment traced(
      {{"LD_TRACE_LOADED_OBJECTS", std::string("1")}}); // the loader lists and ends
  const std::string loaded = Running({}, helper).wait().out;
  EXPECT_NE(loaded.find("libstdc++"), std::string::npos);
  for (const char* library : {"libusb", "libcrypto", "libtbb", "libvtk", "patina"})
    EXPECT_EQ(loaded.find(library), std::string::npos) << loaded;
}

TEST(DevicesCommand, InstallsRulesWithoutLoadingAPlugin) {
  const ScratchFolder folder;
  const Outcome outcome = run({"devices", "--install-udev", folder.path().string()});
  EXPECT_EQ(outcome.exit, 0);
  EXPECT_EQ(outcome.out.find("plugin:"), std::string::npos) << outcome.out;
}

TEST(SimulatedProbe, IsReadFromItsPortWithoutLoss) {
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

TEST(SimulatedProbe, CausesOneLineIfAbsent) {
  const ScratchFolder folder;
  expectOneLineError(run({"simulate-device", "telephone"}),
                     {"DEVICE = telephone: it must be probe"});
}

} // namespace
} // namespace patina::test
