#include "acquisition/recording/recorder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <optional>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "acquisition/files/camera_file.h"
#include "acquisition/files/frame_files.h"
#include "acquisition/recording/min_delay_clock.h"
#include "core/append_file.h"
#include "core/error.h"
#include "core/file.h"
#include "support/fresh_folder.h"
#include "support/rendered_rig.h"

namespace patina {
namespace {

namespace fs = std::filesystem;
using test::RenderedRig;

// A scan of a few frames, repeated for the requested time.
class Recordings : public testing::Test {
 protected:
  static constexpr double kRate = 25;

  Recordings()
      : rig(test::smallCamera(), "4x4_50"), folder(test::freshFolder("recordings")),
        scan(folder / "scan"), made(folder / "made") {
    fs::create_directories(scan / "frames");
    writeFileAtomically(scan / "camera.yml", cameraText(rig.camera));
    writeFileAtomically(scan / "rig.json", rigText({}, rig.markers));
  }
  ~Recordings() override { fs::remove_all(folder); }

  void makeScan(double seconds) {
    std::mt19937 random(8);
    const int count = static_cast<int>(seconds * kRate);
    std::string list = frameListHeader();
    for (int i = 0; i < count; ++i) {
      const fs::path file = scan / "frames" / (frameStem(i) + ".png");
      if (i < 3) {
        poses.push_back(test::somePose(random, 0.4, 0.5));
        writeGrey(file, rig.renderer.render({poses.back()}, {}, 1));
      } else {
        fs::create_symlink(scan / "frames" / (frameStem(i % 3) + ".png"), file);
      }
      list += std::to_string(i) + "," + std::to_string(100 + i / kRate) + "\n";
    }
    writeFileAtomically(scan / "frames.csv", list);
    std::vector<ProbeSample> samples;
    for (int i = 0; i < 500 * seconds; ++i)
      samples.push_back({100 + 0.002 * i, 0.25, {0, 9.8, 0, 9.8}});
    writeProbeStream(scan / "probe.csv", samples);
  }
  RecordingSetup setup() const {
    RecordingSetup out;
    out.folder = made;
    out.camera = scan / "camera.yml";
    out.rig = scan / "rig.json";
    return out;
  }
  std::unique_ptr<Recorder> replaying() const {
    const std::string source = "replay:" + scan.string();
    return std::make_unique<Recorder>(openFrames(source, 0), openProbe(source), setup());
  }
  static RecordingState finished(Recorder& recorder) {
    RecordingState state = recorder.poll().state;
    for (; state.running; state = recorder.poll().state)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return state;
  }

  RenderedRig rig;
  fs::path folder, scan, made;
  std::vector<Pose> poses;
};

TEST_F(Recordings, HoldTheDataOfASourceWithItsTimes) {
  makeScan(1);
  const auto recorder = replaying();
  const RecordingState state = finished(*recorder);
  EXPECT_EQ(state.error, "");
  EXPECT_EQ(state.frames, 25u);
  EXPECT_EQ(state.poses + state.skipped, 25u);
  EXPECT_EQ(state.dropouts, 0u);
  const auto frames = framesOf(made, 0);
  ASSERT_EQ(frames.size(), 25u);
  for (int i = 0; i < 25; ++i) {
    EXPECT_NEAR(frames[index(i)].t - frames[0].t, i / kRate, 0.02);
    EXPECT_EQ(readGrey(frames[index(i)].file).pixel,
              readGrey(scan / "frames" / (frameStem(i) + ".png")).pixel);
  }
  const auto samples = readProbeStream(made / "probe.csv").values;
  EXPECT_EQ(samples.size(), state.samples);
  ASSERT_GE(samples.size(), 480u); // it ends with the frames
  for (std::size_t i = 1; i < samples.size(); ++i)
    EXPECT_NEAR(samples[i].t - samples[i - 1].t, 0.002, 0.002);
  // Both clocks start together.
  EXPECT_NEAR(frames[0].t, samples[0].t, 0.05);
  for (const CameraPose& pose : readPoses(made / "poses.tum").values) {
    const auto at = std::lround((pose.t - frames[0].t) * kRate) % 3;
    EXPECT_LT((pose.position - poses[static_cast<std::size_t>(at)].translation()).norm(), 1e-3);
  }
  EXPECT_EQ(readFile(made / "camera.yml"), readFile(scan / "camera.yml"));
}

TEST_F(Recordings, WaitForTheTrackerAndKeepTheTimesOfFiles) {
  makeScan(2);
  Recorder recorder(openFrames(scan.string(), 0), openProbe((scan / "probe.csv").string()),
                    setup());
  const RecordingState state = finished(recorder);
  EXPECT_EQ(state.error, "");
  EXPECT_EQ(state.poses, 50u);
  EXPECT_EQ(state.skipped, 0u);
  const auto kept = readProbeStream(made / "probe.csv").values,
             sent = readProbeStream(scan / "probe.csv").values;
  ASSERT_EQ(kept.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(kept[i].t, sent[i].t);
    EXPECT_EQ(kept[i].force, sent[i].force);
  }
  EXPECT_EQ(framesOf(made, 0)[49].t, framesOf(scan, 0)[49].t);
}

TEST_F(Recordings, HoldTheGyroscopeOfAProbeThatHasOne) {
  makeScan(1);
  std::string table = probeHeader(true);
  for (int i = 0; i < 500; ++i) {
    const RateSample rate{100 + 0.002 * i, Vec3(0.1, -0.2, 1e-3 * i)};
    table += probeRow({rate.t, 0.25, {0, 9.8, 0, 9.8}}, &rate);
  }
  writeFileAtomically(scan / "probe.csv", table);
  Recorder recorder(openFrames(scan.string(), 0), openProbe((scan / "probe.csv").string()),
                    setup());
  EXPECT_EQ(finished(recorder).error, "");
  std::vector<RateSample> rates;
  const auto kept = readProbeStream(made / "probe.csv", nullptr, &rates).values;
  ASSERT_EQ(kept.size(), 500u);
  ASSERT_EQ(rates.size(), 500u);
  for (int i = 0; i < 500; ++i) EXPECT_EQ(rates[index(i)].rate, Vec3(0.1, -0.2, 1e-3 * i));
}

TEST_F(Recordings, PauseWithoutRenumbering) {
  makeScan(1.6);
  const auto recorder = replaying();
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  recorder->pause();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const RecordingState held = recorder->poll().state;
  EXPECT_TRUE(held.paused);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const RecordingUpdate meanwhile = recorder->poll();
  EXPECT_EQ(meanwhile.state.frames, held.frames);
  EXPECT_EQ(meanwhile.state.samples, held.samples);
  EXPECT_FALSE(meanwhile.samples.empty()); // the live view continues
  recorder->resume();
  const RecordingState state = finished(*recorder);
  EXPECT_EQ(state.dropouts, 0u);
  const auto frames = framesOf(made, 0);
  ASSERT_EQ(frames.size(), state.frames);
  double longest = 0;
  for (std::size_t i = 1; i < frames.size(); ++i)
    longest = std::max(longest, frames[i].t - frames[i - 1].t);
  EXPECT_GT(longest, 0.3);
  EXPECT_EQ(frames.back().file.stem(), frameStem(static_cast<int>(frames.size()) - 1));
}

TEST_F(Recordings, ShowTheNewestFrameWithItsMarkers) {
  makeScan(1);
  const auto recorder = replaying();
  RecordingUpdate news;
  for (int i = 0; i < 200 && !news.frame; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    news = recorder->poll();
  }
  ASSERT_TRUE(news.frame);
  EXPECT_EQ(news.frame->image.width, 640);
  EXPECT_EQ(news.frame->verdict, RigVerdict::seen);
  EXPECT_FALSE(news.frame->markers.empty());
  EXPECT_TRUE(news.frame->pose);
  recorder->stop();
  EXPECT_FALSE(recorder->poll().state.running);
}

TEST_F(Recordings, RefuseAFolderThatHoldsAScan) {
  makeScan(0.2);
  const std::string before = readFile(scan / "frames.csv");
  RecordingSetup over = setup();
  over.folder = scan;
  EXPECT_THROW(Recorder(openFrames("replay:" + scan.string(), 0), nullptr, over), FileError);
  EXPECT_EQ(readFile(scan / "frames.csv"), before);
  EXPECT_THROW(Recorder(openFrames("replay:" + scan.string(), 0),
                        openProbe((scan / "probe.csv").string()), setup()),
               Error);
  EXPECT_FALSE(fs::exists(made));
}

// A recording that was killed before its first row hinders no later one.
TEST_F(Recordings, ReplaceOneThatNeverBegan) {
  makeScan(0.2);
  const auto record = [&] {
    Recorder recorder(openFrames("replay:" + scan.string(), 0), nullptr, setup());
    EXPECT_EQ(finished(recorder).error, "");
  };
  const auto leave = [&](const std::optional<std::string>& table, const char* other = "") {
    fs::remove_all(made);
    fs::create_directories(made / "frames");
    writeFileAtomically(made / "frames" / "000000.pgm", "P5");
    if (*other) writeFileAtomically(made / other, "0 0 0 0 0 0 0 1");
    if (table) writeFileAtomically(made / "frames.csv", *table);
  };
  const auto kept = [&] { return readFile(made / "frames" / "000000.pgm") == "P5"; };
  for (const std::string& own : {frameListHeader(), std::string()}) {
    leave(own);
    EXPECT_NO_THROW(record());
    EXPECT_FALSE(kept());
  }
  // Everything else stays: pictures without a table, a row without a line's end, a foreign file, a
  // table of others.
  leave({});
  EXPECT_THROW(record(), FileError);
  EXPECT_TRUE(kept());
  leave(frameListHeader() + "0,0.5");
  EXPECT_THROW(record(), FileError);
  EXPECT_TRUE(kept());
  for (const char* other : {"frames/notes.txt", "poses.tum"}) {
    leave(frameListHeader(), other);
    EXPECT_THROW(record(), FileError);
    EXPECT_TRUE(kept());
    EXPECT_TRUE(fs::exists(made / other));
  }
  leave(frameListHeader());
  fs::create_symlink(folder / "nowhere", made / "poses.tum"); // a link to nothing
  EXPECT_THROW(record(), FileError);
  EXPECT_TRUE(kept());
  // A refusal for another cause leaves even a recorder's own.
  leave(frameListHeader());
  writeFileAtomically(made / "camera.yml", "another");
  EXPECT_THROW(record(), FileError);
  EXPECT_TRUE(kept());
  leave(frameListHeader());
  const AppendFile recording(made / "frames.csv");
  EXPECT_THROW(record(), FileError);
  EXPECT_TRUE(kept());
}

TEST_F(Recordings, EndWithFramesOfAnotherSize) {
  makeScan(0.4);
  const auto spoil = [&](const char* frame) {
    writeGrey(scan / "frames" / frame, {320, 240, std::vector<std::uint8_t>(320 * 240, 9)});
  };
  spoil("000006.png");
  // On a busy machine this frame may be the first one that is read.
  std::size_t came = 0;
  for (int time = 0; time < 20 && came == 0; ++time) {
    EXPECT_FALSE(fs::exists(made));
    const auto recorder = replaying();
    const RecordingState state = finished(*recorder);
    EXPECT_NE(state.error.find("is 320 x 240"), std::string::npos);
    came = state.frames + state.samples;
  }
  ASSERT_GT(came, 0u);
  EXPECT_TRUE(fs::exists(made)) << "what came before it is kept";
  fs::remove_all(made);
  spoil("000000.png");
  {
    Recorder alone(openFrames("replay:" + scan.string(), 0), nullptr, setup());
    EXPECT_NE(finished(alone).error.find("is 320 x 240"), std::string::npos);
  }
  EXPECT_FALSE(fs::exists(made)) << "nothing came that would be lost";
}

// A process that records and is killed, or whose disk is full, at some moment.
class RecordingChild : public Recordings {
 protected:
  template <class Prepare> pid_t started(const Prepare& prepare) const {
    const pid_t child = fork();
    if (child != 0) return child;
    prepare();
    const auto recorder = replaying();
    const RecordingState state = finished(*recorder);
    _exit(state.error.find("cannot be written") != std::string::npos ? 7 : 3);
  }
  static int statusOf(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return status;
  }
  void isWhole(const fs::path& into) const {
    // Pictures are written as they arrive and show the progress.
    std::size_t pictures = 0;
    for (const auto& file : fs::directory_iterator(into / "frames"))
      pictures += file.path().extension() == ".pgm";
    const auto frames = framesOf(into, 0);
    EXPECT_GE(frames.size() + static_cast<std::size_t>(kRate), pictures);
    const auto samples = readProbeStream(into / "probe.csv").values;
    EXPECT_GT(samples.back().t, frames[0].t + static_cast<double>(pictures) / kRate - 1);
    EXPECT_GT(readPoses(into / "poses.tum").values.size(), 5u);
    // Every listed file is complete.
    Progress progress;
    const TrackedFrames found =
        trackFrames(*openFrames(into.string(), 0), rig.camera, rig.markers, {}, progress);
    EXPECT_EQ(found.poses.size(), frames.size());
    EXPECT_EQ(found.unreadable, 0u);
  }
};

TEST_F(RecordingChild, LosesLessThanASecondIfKilled) {
  makeScan(4);
  std::mt19937 random(5);
  constexpr int kTogether = 3;
  for (int round = 0; round < 2; ++round) {
    std::vector<std::pair<fs::path, pid_t>> children;
    for (int i = 0; i < kTogether; ++i) {
      made = folder / ("made" + std::to_string(kTogether * round + i));
      const pid_t child = started([] {});
      children.emplace_back(made, child);
    }
    // The last recording has also run for a while.
    const auto has = [&] { return fs::exists(made / "frames" / "000020.pgm"); };
    for (int i = 0; i < 1000 && !has(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_TRUE(has());
    for (const auto& [into, child] : children) {
      std::this_thread::sleep_for(std::chrono::microseconds(random() % 330000));
      kill(child, SIGKILL);
      ASSERT_TRUE(WIFSIGNALED(statusOf(child)));
    }
    for (const auto& [into, child] : children) isWhole(into);
  }
}

TEST_F(RecordingChild, ReportsAFullDiskAndKeepsItsData) {
  makeScan(4);
  // Frames are so small that the probe's table is the first file to reach the limit.
  Camera small = rig.camera;
  small.width = 64, small.height = 48;
  writeFileAtomically(scan / "camera.yml", cameraText(small));
  for (int i = 0; i < 3; ++i)
    writeGrey(scan / "frames" / (frameStem(i) + ".png"),
              {64, 48, std::vector<std::uint8_t>(64 * 48, 100)});
  const pid_t child = started([] {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit least{20000, 20000}; // [bytes] of a file
    setrlimit(RLIMIT_FSIZE, &least);
  });
  const int status = statusOf(child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 7); // reported at once, before the end of the scan
  const auto samples = readProbeStream(made / "probe.csv").values;
  EXPECT_GT(samples.size(), 250u);
  EXPECT_LT(samples.size(), 600u); // 385 were, of 2000
  EXPECT_GT(framesOf(made, 0).size(), 10u);
}

TEST(MinDelayClock, KeepsTheEvenStepsOfTheSourceAtMinimumDelay) {
  MinDelayClock clock;
  std::mt19937 random(3);
  std::exponential_distribution<double> late(200); // 5 ms on average
  double worst = 0, last = -1;
  for (int i = 0; i < 5000; ++i) {
    const double stamp = 70 + 0.002 * i, sent = 1 + 0.002 * i * (1 + 5e-5);
    const double t = clock.timeOf(stamp, sent + late(random));
    EXPECT_GT(t, last);
    last = t;
    if (i > 500) worst = std::max(worst, std::abs(t - sent));
  }
  std::printf("worst after a second: %.3f ms\n", 1e3 * worst);
  EXPECT_LT(worst, 1.5e-3);
}

} // namespace
} // namespace patina
