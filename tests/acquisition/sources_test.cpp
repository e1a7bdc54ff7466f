#include "acquisition/sources/sources.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fcntl.h>
#include <future>
#include <opencv2/videoio.hpp>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include "acquisition/files/frame_files.h"
#include "acquisition/files/scan_files.h"
#include "core/error.h"
#include "core/file.h"
#include "support/fresh_folder.h"

namespace patina {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

class Sources : public testing::Test {
 protected:
  Sources() : folder(test::freshFolder("sources")) { fs::create_directories(folder / "frames"); }
  ~Sources() override { fs::remove_all(folder); }

  // Each frame has a grey of its own.
  static GreyFrame frameOf(int i) {
    return {64, 48, std::vector<std::uint8_t>(64 * 48, static_cast<std::uint8_t>(20 + 10 * i))};
  }
  void makeScan(int count) {
    std::string list = "frame,t [s]\n";
    std::vector<ProbeSample> samples;
    for (int i = 0; i < count; ++i) {
      writeGrey(folder / "frames" / (frameStem(i) + ".png"), frameOf(i));
      list += std::to_string(i) + "," + std::to_string(5 + 0.05 * i) + "\n";
      for (int k = 0; k < 25; ++k) samples.push_back({5.01 + 0.05 * i + 0.002 * k, 0.1 * i, {}});
    }
    writeFileAtomically(folder / "frames.csv", list);
    writeProbeStream(folder / "probe.csv", samples);
  }
  // What next() or read() throws.
  template <class Work> static std::string causeOf(const Work& work) {
    try {
      work();
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  }

  fs::path folder;
};

TEST_F(Sources, GiveAFoldersFramesInTheirOrder) {
  makeScan(4);
  writeFileAtomically(folder / "frames" / "000002.png", "no picture");
  const auto source = openFrames(folder.string(), 0);
  EXPECT_EQ(source->count(), 4u);
  EXPECT_FALSE(source->isLive());
  for (int i = 0; i < 4; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_DOUBLE_EQ(frame->t, 5 + 0.05 * i);
    if (i == 2)
      EXPECT_NE(frame->fault.find("000002.png"), std::string::npos);
    else
      EXPECT_EQ(frame->image.pixel, frameOf(i).pixel);
  }
  EXPECT_FALSE(source->next());
}

TEST_F(Sources, ReplayFramesAndSamplesAtTheirOwnPace) {
  makeScan(8);
  const auto frames = openFrames("replay:" + folder.string(), 0);
  const auto probe = openProbe("replay:" + folder.string());
  EXPECT_TRUE(frames->isLive());
  std::vector<ProbeSample> samples;
  auto reading = std::async(std::launch::async, [&] {
    while (probe->read(samples)) {
    }
  });
  const auto begin = Clock::now();
  for (int i = 0; i < 8; ++i) {
    const auto frame = frames->next();
    ASSERT_TRUE(frame);
    EXPECT_GE(since(begin), 0.05 * i);
  }
  EXPECT_FALSE(frames->next());
  reading.get();
  EXPECT_GE(since(begin), 0.4); // the last sample's time
  EXPECT_EQ(samples.size(), 200u);
}

TEST_F(Sources, AFrameThatIsMissingIsAGapAndAllOfThemAnError) {
  makeScan(3);
  fs::remove(folder / "frames" / "000000.png");
  EXPECT_NO_THROW((void)openFrames(folder.string(), 0));
  fs::remove_all(folder / "frames");
  for (const char* way : {"", "replay:"})
    EXPECT_EQ(causeOf([&] { (void)openFrames(way + folder.string(), 0); }),
              (folder / "frames").string() +
                  ": holds none of the 3 pictures that frames.csv lists");
}

TEST_F(Sources, AFrameListedTwiceIsRefusedWithBothLines) {
  const std::string list = "frame,t [s]\n4,1\n5,2\n4,3\n";
  EXPECT_EQ(causeOf([&] { (void)parseFrameList(list, "frames.csv"); }),
            "frames.csv:4: frame 4 stands in line 2 already");
}

TEST_F(Sources, ThatAreStoppedEndAtOnce) {
  makeScan(2);
  writeFileAtomically(folder / "frames.csv", "frame,t [s]\n0,5\n1,500\n");
  writeFileAtomically(folder / "probe.csv", readFile(folder / "probe.csv") + "600,0,0,0,0,0\n");
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const auto frames = openFrames("replay:" + folder.string(), 0);
  const auto replayed = openProbe("replay:" + folder.string());
  const auto stream = openProbe("stream:" + pipe.string()); // nobody writes to it
  const auto ended = [](const auto& work) { return std::async(std::launch::async, work); };
  auto a = ended([&] {
    while (frames->next()) {
    }
  });
  auto b = ended([&] {
    std::vector<ProbeSample> samples;
    while (replayed->read(samples)) {
    }
  });
  auto c = ended([&] {
    std::vector<ProbeSample> samples;
    while (stream->read(samples)) {
    }
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const auto begin = Clock::now();
  frames->stop();
  replayed->stop();
  stream->stop();
  a.get(), b.get(), c.get();
  EXPECT_LT(since(begin), 0.2);
}

class Streams : public Sources {
 protected:
  Streams() {
    pipe = folder / "pipe";
    EXPECT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    source = openProbe("stream:" + pipe.string());
    writer = open(pipe.c_str(), O_WRONLY);
  }
  ~Streams() override { hangUp(); }
  void push(const std::string& text) const {
    EXPECT_EQ(write(writer, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void hangUp() {
    if (writer >= 0) close(writer);
    writer = -1;
  }
  std::vector<ProbeSample> read() const {
    std::vector<ProbeSample> samples;
    EXPECT_TRUE(source->read(samples));
    return samples;
  }
  static std::string row(int i) {
    return std::to_string(0.002 * i) + ",1.5,0,9.8,0," + std::to_string(i) + "\r\n";
  }

  fs::path pipe;
  std::unique_ptr<ProbeSource> source;
  int writer = -1;
};

TEST_F(Streams, GiveLinesAsTheyArriveInWhateverPieces) {
  push(probeHeader() + row(0) + row(1).substr(0, 7));
  EXPECT_EQ(read().size(), 1u);
  auto later = std::async(std::launch::async, [&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    push(row(1).substr(7) + "\n" + row(2));
  });
  const auto two = read();
  later.get();
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].acceleration[3], 1);
  EXPECT_EQ(two[1].t, 0.004);
  hangUp();
  std::vector<ProbeSample> none;
  EXPECT_FALSE(source->read(none));
}

TEST_F(Streams, MayHaveMoreColumnsAndThenHaveThemInEachLine) {
  std::string header = probeHeader();
  header.insert(header.find_first_of("\r\n"), ",battery [V]");
  push(header + "0,1.5,0,9.8,0,1,3.3\n");
  EXPECT_EQ(read().at(0).acceleration[3], 1);
  push("0.002,1.5,0,9.8,0,1\n");
  std::vector<ProbeSample> samples;
  const std::string cause = causeOf([&] { source->read(samples); });
  EXPECT_NE(cause.find("pipe:3: 6 values where the header names 7"), std::string::npos) << cause;
}

TEST_F(Streams, NameALineThatIsWrongAfterThoseBeforeIt) {
  push(probeHeader() + row(0) + row(1) + "0,006;1;2\n" + row(4));
  std::vector<ProbeSample> samples;
  const std::string cause = causeOf([&] { source->read(samples); });
  EXPECT_EQ(samples.size(), 2u);
  EXPECT_NE(cause.find("pipe:4: decimal commas"), std::string::npos) << cause;
}

TEST_F(Streams, SayThatTheirTimeRunsBackwards) {
  push(probeHeader() + row(5) + row(4));
  std::vector<ProbeSample> samples;
  const std::string cause = causeOf([&] { source->read(samples); });
  EXPECT_NE(cause.find("pipe:3: time runs backwards"), std::string::npos) << cause;
}

TEST_F(Streams, SayThatTheWriterWentWithinALine) {
  push(probeHeader() + row(0) + "0.002,1.5,0");
  EXPECT_EQ(read().size(), 1u);
  hangUp();
  std::vector<ProbeSample> samples;
  const std::string cause = causeOf([&] { source->read(samples); });
  EXPECT_NE(cause.find("pipe:3: the stream ended within this line"), std::string::npos) << cause;
}

TEST_F(Streams, RefuseWhatIsNoProbesStream) {
  push("time,force\n");
  std::vector<ProbeSample> samples;
  const std::string cause = causeOf([&] { source->read(samples); });
  EXPECT_NE(cause.find("pipe:1: header is 'time,force'"), std::string::npos) << cause;
}

TEST(SerialStreams, LeaveOutTheLineThatHadBegun) {
  const int master = posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_GE(master, 0);
  ASSERT_EQ(grantpt(master) | unlockpt(master), 0);
  const auto source = openProbe(std::string("stream:") + ptsname(master));
  const std::string text = "02,1,1,1\n0.004,1,2,3,4,5\n0.006,1,2,3,4,5\n";
  ASSERT_EQ(write(master, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  std::vector<ProbeSample> samples;
  ASSERT_TRUE(source->read(samples));
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[0].t, 0.004);
  close(master);
}

TEST(SerialStreams, SayThatTheDeviceIsGone) {
  const int master = posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_GE(master, 0);
  ASSERT_EQ(grantpt(master) | unlockpt(master), 0);
  const std::string name = ptsname(master);
  const auto source = openProbe("stream:" + name);
  close(master);
  std::vector<ProbeSample> samples;
  std::string cause = "nothing";
  try {
    source->read(samples);
  } catch (const Error& error) {
    cause = error.what();
  }
  EXPECT_NE(cause.find(name + ": the probe is gone"), std::string::npos) << cause;
  EXPECT_TRUE(samples.empty());
}

class Videos : public Sources {
 protected:
  // Motion JPEG: each frame stands for itself.
  std::string made(int count) const {
    const std::string path = (folder / "video.avi").string();
    cv::VideoWriter writer(path, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25, {64, 48}, false);
    EXPECT_TRUE(writer.isOpened());
    for (int i = 0; i < count; ++i) {
      const GreyFrame frame = frameOf(i);
      writer.write(cv::Mat(48, 64, CV_8UC1, const_cast<std::uint8_t*>(frame.row(0))));
    }
    return path;
  }
};

TEST_F(Videos, GiveTheirFramesByNumberAtTheirRate) {
  const std::string path = made(10);
  for (const double rate : {0., 50.}) {
    const auto source = openFrames(path, rate);
    EXPECT_EQ(source->count(), 10u);
    for (int i = 0; i < 10; ++i) {
      const auto frame = source->next();
      ASSERT_TRUE(frame);
      EXPECT_DOUBLE_EQ(frame->t, i / (rate > 0 ? rate : 25));
      EXPECT_EQ(frame->name, path + " frame " + std::to_string(i));
      ASSERT_EQ(frame->image.width, 64);
      EXPECT_NEAR(frame->image.row(20)[30], 20 + 10 * i, 2);
    }
    EXPECT_FALSE(source->next());
  }
}

TEST_F(Videos, ThatAreDamagedSayWhereTheyEnd) {
  const std::string path = made(60);
  fs::resize_file(path, fs::file_size(path) / 2);
  testing::internal::CaptureStderr();
  std::string fault;
  try {
    const auto source = openFrames(path, 0);
    while (const auto frame = source->next())
      if (!frame->fault.empty()) fault = frame->fault;
  } catch (const FileError& error) {
    fault = error.what(); // without its index it may not open at all
  }
  EXPECT_NE(fault.find("video.avi: "), std::string::npos) << fault;
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(Videos, AndCamerasThatAreNoneAreRefusedInOneLine) {
  writeFileAtomically(folder / "text.mp4", "no video");
  testing::internal::CaptureStderr();
  EXPECT_NE(causeOf([&] {
              openFrames((folder / "text.mp4").string(), 0);
            }).find("text.mp4: is no video that can be read"),
            std::string::npos);
  EXPECT_NE(causeOf([&] { openFrames("camera:97", 0); }).find("there is no /dev/video97"),
            std::string::npos);
  EXPECT_NE(causeOf([&] { openFrames("camera:x", 0); }).find("a camera has a number"),
            std::string::npos);
  EXPECT_NE(causeOf([&] { openFrames((folder / "none").string(), 0); }).find("does not exist"),
            std::string::npos);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

} // namespace
} // namespace patina
