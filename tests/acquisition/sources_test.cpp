#include "acquisition/sources/sources.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fcntl.h>
#include <future>
#include <opencv2/videoio.hpp>
#include <sstream>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include "acquisition/files/frame_files.h"
#include "acquisition/files/scan_tables.h"
#include "core/descriptor.h"
#include "core/error.h"
#include "core/file.h"
#include "support/fresh_folder.h"
#include "support/oriented_pictures.h"

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

  // Each frame has its own grey value.
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
  // Returns the message that next() or read() throws.
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

TEST_F(Sources, RecogniseImagesByContentAndCountTheRest) {
  const fs::path pictures = folder / "pictures";
  fs::create_directories(pictures);
  writeFileAtomically(pictures / "IMG_10.JPG", test::jpegOf(frameOf(3)));
  writeFileAtomically(pictures / "IMG_9.jpeg", test::jpegOf(frameOf(2)));
  writeGrey(folder / "one.png", frameOf(0));
  fs::rename(folder / "one.png", pictures / "IMG_0001.PNG");
  writeGrey(folder / "two.png", frameOf(1));
  fs::rename(folder / "two.png", pictures / "IMG_2.webp"); // a wrong name ending
  test::writeTiff(pictures / "IMG_11", frameOf(4), 1);
  for (const char* other : {"Thumbs.db", "readme.txt", ".DS_Store", "._IMG_9.jpeg"})
    writeFileAtomically(pictures / other, "no picture");
  writeFileAtomically(pictures / "camera.yml", "of the scan");
  writeFileAtomically(pictures / "IMG_12.JPG", "damaged");
  const auto source = openFrames(pictures.string(), 10);
  for (int i = 0; i < 5; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_DOUBLE_EQ(frame->t, 0.1 * i);
    ASSERT_EQ(frame->image.width, 64) << frame->fault;
    EXPECT_NEAR(frame->image.row(20)[30], 20 + 10 * i, 2) << frame->name;
  }
  // A file that lost its picture is an unreadable frame.
  EXPECT_NE(source->next()->fault.find("IMG_12.JPG: cannot be read"), std::string::npos);
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->notes(),
            std::vector{pictures.string() +
                        ": 4 files are no pictures and are left out: .DS_Store, ..."});
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

TEST_F(Sources, OneMissingFrameIsAGapAndAllMissingAnError) {
  makeScan(3);
  fs::remove(folder / "frames" / "000000.png");
  EXPECT_NO_THROW((void)openFrames(folder.string(), 0));
  fs::remove_all(folder / "frames");
  for (const char* way : {"", "replay:"})
    EXPECT_EQ(causeOf([&] { (void)openFrames(way + folder.string(), 0); }),
              (folder / "frames").string() +
                  ": holds none of the 3 pictures that frames.csv lists");
}

TEST_F(Sources, FrameListedTwiceIsRejectedWithBothLines) {
  const std::string list = "frame,t [s]\n4,1\n5,2\n4,3\n";
  EXPECT_EQ(causeOf([&] { (void)parseFrameList(list, "frames.csv"); }),
            "frames.csv:4: frame 4 stands in line 2 already");
}

TEST_F(Sources, EndAtOnceIfStopped) {
  makeScan(2);
  writeFileAtomically(folder / "frames.csv", "frame,t [s]\n0,5\n1,500\n");
  writeFileAtomically(folder / "probe.csv", readFile(folder / "probe.csv") + "600,0,0,0,0,0\n");
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const auto frames = openFrames("replay:" + folder.string(), 0);
  const auto replayed = openProbe("replay:" + folder.string());
  const auto stream = openProbe("stream:" + pipe.string()); // a pipe without a writer
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

TEST_F(Streams, GiveLinesAsTheyArriveInAnyPieces) {
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

TEST_F(Streams, MayHaveMoreColumnsIfEachLineHasThem) {
  std::string header = probeHeader();
  header.insert(header.find_first_of("\r\n"), ",battery [V]");
  push(header + "0,1.5,0,9.8,0,1,3.3\n");
  EXPECT_EQ(read().at(0).acceleration[3], 1);
  push("0.002,1.5,0,9.8,0,1\n");
  std::vector<ProbeSample> samples;
  const std::string cause = causeOf([&] { source->read(samples); });
  EXPECT_NE(cause.find("pipe:3: 6 values where the header names 7"), std::string::npos) << cause;
}

TEST_F(Streams, NameAWrongLineAfterReadingTheLinesBefore) {
  push(probeHeader() + row(0) + row(1) + "0,006;1;2\n" + row(4));
  std::vector<ProbeSample> samples;
  const std::string cause = causeOf([&] { source->read(samples); });
  EXPECT_EQ(samples.size(), 2u);
  EXPECT_NE(cause.find("pipe:4: decimal commas"), std::string::npos) << cause;
}

TEST_F(Streams, ReportTimeThatRunsBackwards) {
  push(probeHeader() + row(5) + row(4));
  std::vector<ProbeSample> samples;
  const std::string cause = causeOf([&] { source->read(samples); });
  EXPECT_NE(cause.find("pipe:3: time runs backwards"), std::string::npos) << cause;
}

TEST_F(Streams, ReportAWriterThatEndsWithinALine) {
  push(probeHeader() + row(0) + "0.002,1.5,0");
  EXPECT_EQ(read().size(), 1u);
  hangUp();
  std::vector<ProbeSample> samples;
  const std::string cause = causeOf([&] { source->read(samples); });
  EXPECT_NE(cause.find("pipe:3: the stream ended within this line"), std::string::npos) << cause;
}

TEST_F(Streams, RejectOtherData) {
  push("time,force\n");
  std::vector<ProbeSample> samples;
  const std::string cause = causeOf([&] { source->read(samples); });
  EXPECT_NE(cause.find("pipe:1: header is 'time,force'"), std::string::npos) << cause;
}

TEST(SerialStreams, SkipTheFirstPartialLine) {
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

// Sends a text over a pseudo-terminal and reads what comes of it.
struct TextOverSerial {
  explicit TextOverSerial(const std::string& text) {
    const Descriptor ours(posix_openpt(O_RDWR | O_NOCTTY));
    EXPECT_EQ(grantpt(ours.get()) | unlockpt(ours.get()), 0);
    const auto source = openProbe(std::string("stream:") + ptsname(ours.get()) + "@115200");
    EXPECT_EQ(write(ours.get(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
    const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    try {
      // The source is stopped once nothing more can come.
      auto watch = std::async(std::launch::async, [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        source->stop();
      });
      while (samples.size() < lines && source->read(samples, &rates)) {
      }
    } catch (const Error& error) {
      cause = error.what();
      cause.erase(0, cause.find(':')); // the name of the terminal
    }
  }
  std::vector<ProbeSample> samples;
  std::vector<RateSample> rates;
  std::string cause;
};

TEST(SerialStreams, ReadAGyroscopeInTheUnitsOfTheHeader) {
  const TextOverSerial got("t [ms],wx [deg/s],wy [deg/s],wz [deg/s],force [mN],"
                           "a1u [g],a1v [g],a2u [g],a2v [g]\n"
                           "2,90,0,-180,500,0,1,0.5,1\n4,0,0,0,0,0,0,0,0\n");
  EXPECT_EQ(got.cause, "");
  ASSERT_EQ(got.samples.size(), 2u);
  ASSERT_EQ(got.rates.size(), 2u);
  EXPECT_DOUBLE_EQ(got.samples[0].t, 0.002);
  EXPECT_DOUBLE_EQ(got.samples[0].force, 0.5);
  EXPECT_DOUBLE_EQ(got.samples[0].acceleration[2], 0.5 * 9.80665);
  EXPECT_EQ(got.rates[0].t, got.samples[0].t);
  EXPECT_NEAR((got.rates[0].rate - std::numbers::pi * Vec3(0.5, 0, -1)).norm(), 0, 1e-12);
}

TEST(SerialStreams, AssumeTheOrderOfTheDocumentsIfJoinedWithoutAHeader) {
  const TextOverSerial got("1,2,3\n0.004,1,2,3,4,5,6,7,8\n0.006,1,2,3,4,5,6,7,8\n" +
                           probeHeader(true) + "0.008,1,2,3,4,5,6,7,8\n");
  EXPECT_EQ(got.cause, "");
  ASSERT_EQ(got.samples.size(), 3u);
  ASSERT_EQ(got.rates.size(), 3u);
  EXPECT_EQ(got.rates[2].rate, Vec3(6, 7, 8));
}

TEST(SerialStreams, RejectAHeaderThatContradictsTheNumbersBeforeIt) {
  const TextOverSerial got("1,2,3\n0.004,1,2,3,4,5\n"
                           "t [ms],force [N],a1u [m/s^2],a1v [m/s^2],a2u [m/s^2],a2v [m/s^2]\n");
  EXPECT_EQ(got.samples.size(), 1u);
  EXPECT_EQ(got.cause, ":3: is not the header 't [s],force [N],a1u [m/s^2],a1v [m/s^2],a2u "
                       "[m/s^2],a2v [m/s^2]' of the numbers before it: send that one first after "
                       "each start");
}

TEST(SerialStreams, RejectHalfAGyroscope) {
  const TextOverSerial got("t [s],force [N],a1u [m/s^2],a1v [m/s^2],a2u [m/s^2],a2v [m/s^2],"
                           "wx [rad/s]\n0,1,2,3,4,5,6\n");
  EXPECT_NE(got.cause.find("has 1 of the gyroscope's columns"), std::string::npos) << got.cause;
}

TEST(SerialStreams, ReportALostDevice) {
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
  // In Motion JPEG each frame is coded alone.
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

// Matroska with Motion JPEG pictures, each with a time of its own [ms], as its format has it.
std::string matroska(const std::vector<std::string>& pictures, const std::vector<int>& times) {
  const auto element = [](std::uint32_t id, const std::string& body) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8)
      if (id >> shift) text += static_cast<char>(id >> shift & 0xff);
    text += '\x08'; // seven bytes of size follow
    text.back() = '\x01';
    for (int shift = 48; shift >= 0; shift -= 8)
      text += static_cast<char>(std::uint64_t{body.size()} >> shift & 0xff);
    return text + body;
  };
  const auto number = [](std::uint32_t value) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 0xff);
    return text;
  };
  std::string blocks = element(0xE7, number(0));
  for (std::size_t i = 0; i < pictures.size(); ++i)
    blocks += element(0xA3, std::string("\x81") + static_cast<char>(times[i] >> 8) +
                                static_cast<char>(times[i] & 0xff) + '\x80' + pictures[i]);
  const std::string track = element(0xD7, number(1)) + element(0x73C5, number(1)) +
                            element(0x83, number(1)) + element(0x86, "V_MJPEG") +
                            element(0xE0, element(0xB0, number(64)) + element(0xBA, number(48)));
  return element(0x1A45DFA3, element(0x4282, "matroska")) +
         element(0x18538067, element(0x1549A966, element(0x2AD7B1, number(1000000))) +
                                 element(0x1654AE6B, element(0xAE, track)) +
                                 element(0x1F43B675, blocks));
}

// Times of the remaining frames.
std::vector<double> timesOf(FrameSource& source) {
  std::vector<double> times;
  while (const auto frame = source.next()) {
    EXPECT_EQ(frame->fault, "");
    times.push_back(frame->t);
  }
  return times;
}

TEST_F(Videos, HaveTheTimesOfTheirContainer) {
  const std::vector<int> times{0, 40, 73, 106, 371, 404, 410, 900, 933};
  std::vector<std::string> pictures;
  for (std::size_t i = 0; i < times.size(); ++i)
    pictures.push_back(test::jpegOf(frameOf(static_cast<int>(i))));
  const std::string path = (folder / "varies.mkv").string();
  writeFileAtomically(path, matroska(pictures, times));
  const auto source = openFrames(path, 0);
  const auto found = timesOf(*source);
  ASSERT_EQ(found.size(), times.size());
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(found[i], 1e-3 * times[i], 1e-9);
  EXPECT_TRUE(source->notes().empty());
  // A given rate overrules them.
  const auto even = timesOf(*openFrames(path, 50));
  ASSERT_EQ(even.size(), times.size());
  EXPECT_DOUBLE_EQ(even.back(), 0.16);
}

TEST_F(Videos, NeedARateIfTheyHaveNoTimes) {
  std::string bytes;
  for (int i = 0; i < 5; ++i) bytes += test::jpegOf(frameOf(i));
  const std::string path = (folder / "raw.mjpeg").string();
  writeFileAtomically(path, bytes);
  EXPECT_NE(causeOf([&] {
              (void)timesOf(*openFrames(path, 0));
            }).find("raw.mjpeg: has neither frame times nor a frame rate"),
            std::string::npos);
  const auto told = openFrames(path, 10);
  EXPECT_DOUBLE_EQ(timesOf(*told)[4], 0.4);
  EXPECT_TRUE(told->notes().empty());
}

// The reference is the output of the program ffprobe, which comes with FFmpeg like the library.
class ProbedVideos : public Videos {
 protected:
  static std::string output(const std::string& command) {
    std::string text;
    FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) return text;
    char part[4096];
    while (const std::size_t got = fread(part, 1, sizeof part, pipe)) text.append(part, got);
    pclose(pipe);
    return text;
  }
  static std::vector<double> probed(const std::string& path) {
    std::istringstream lines(output("ffprobe -v error -select_streams v -show_entries "
                                    "frame=best_effort_timestamp_time -of csv=p=0 " +
                                    path));
    std::vector<double> times;
    for (std::string line; std::getline(lines, line);)
      if (!line.empty()) times.push_back(std::stod(line));
    return times;
  }
};

TEST_F(ProbedVideos, HaveTheTimesReportedByFfprobe) {
  if (output("ffmpeg -version 2>/dev/null").empty() || output("ffprobe -version").empty())
    GTEST_SKIP() << "ffmpeg is absent (Debian: ffmpeg)";
  // Some of 60 frames a second are missing, so that two time steps differ by 265 ms.
  const std::string source =
      "ffmpeg -v error -y -f lavfi -i testsrc2=size=160x120:rate=60:duration=1.5 -vf "
      "\"select='not(eq(mod(n\\,7)\\,3))*not(between(n\\,30\\,45))'\" -vsync vfr "
      "-enc_time_base 1:90000 -pix_fmt yuv420p ";
  double most = 0;
  for (const auto& [options, name] : std::vector<std::pair<std::string, std::string>>{
           {"-c:v libx264", "reordered.mp4"},
           {"-c:v libx264 -bf 0", "plain.mp4"},
           {"-c:v libx264", "reordered.mkv"},
           {"-c:v libx265 -x265-params log-level=none", "hevc.mp4"},
           {"-c:v libvpx-vp9", "vp9.webm"},
           {"-c:v libx264", "stream.ts"},
           {"-c:v mjpeg -pix_fmt yuvj420p", "fine.avi"}}) {
    const std::string path = (folder / name).string();
    (void)output(source + options + " " + path + " 2>/dev/null");
    if (!fs::exists(path) || fs::file_size(path) == 0) continue; // FFmpeg may lack that coder
    const auto truth = probed(path), found = timesOf(*openFrames(path, 0));
    ASSERT_EQ(found.size(), truth.size()) << name;
    ASSERT_GT(found.size(), 50u) << name;
    for (std::size_t i = 0; i < found.size(); ++i)
      most = std::max(most, std::abs(found[i] - (truth[i] - truth[0])));
  }
  std::printf("off by %.3g ms at most\n", 1e3 * most);
  EXPECT_LE(most, 1e-3);
  // The beginning is cut off but still in the file: nothing is damaged.
  const std::string whole = (folder / "reordered.mp4").string(), cut = folder / "cut.mp4";
  (void)output("ffmpeg -v error -y -ss 0.33 -i " + whole + " -c copy " + cut + " 2>/dev/null");
  ASSERT_TRUE(fs::exists(cut));
  EXPECT_EQ(timesOf(*openFrames(cut, 30)).size(), probed(cut).size());
  EXPECT_EQ(timesOf(*openFrames((folder / "reordered.mkv").string(), 30)).size(),
            probed(folder / "reordered.mkv").size());
  EXPECT_EQ(timesOf(*openFrames(cut, 0)).size(), probed(cut).size());
  // The file contains only pictures: FFmpeg assumes 25 a second.
  const std::string raw = folder / "raw.mjpeg";
  (void)output(source + "-c:v mjpeg -pix_fmt yuvj420p " + raw + " 2>/dev/null");
  const auto even = openFrames(raw, 0);
  EXPECT_NEAR(timesOf(*even)[10], 0.4, 1e-9);
  ASSERT_EQ(even->notes().size(), 1u);
  EXPECT_NE(even->notes()[0].find("raw.mjpeg: has no frame times, so 25 frames per second are"),
            std::string::npos)
      << even->notes()[0];
  // A video from an upright phone carries its rotation.
  const std::string upright = folder / "upright.mp4";
  (void)output("ffmpeg -v error -y -i " + whole + " -c copy -metadata:s:v rotate=90 " + upright +
               " 2>/dev/null");
  const auto first = openFrames(upright, 0)->next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->image.orientation, 6);
  EXPECT_EQ(first->image.width, 120);
}

TEST_F(Videos, ReportTheirEndIfDamaged) {
  const std::string path = made(60);
  fs::resize_file(path, fs::file_size(path) / 2);
  testing::internal::CaptureStderr();
  std::string fault;
  try {
    const auto source = openFrames(path, 0);
    while (const auto frame = source->next())
      if (!frame->fault.empty()) fault = frame->fault;
  } catch (const FileError& error) {
    fault = error.what(); // it may not open without its index
  }
  EXPECT_NE(fault.find("video.avi: "), std::string::npos) << fault;
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(Videos, AndCamerasAreRejectedInOneLineIfInvalid) {
  writeFileAtomically(folder / "text.mp4", "no video");
  testing::internal::CaptureStderr();
  EXPECT_NE(causeOf([&] {
              openFrames((folder / "text.mp4").string(), 0);
            }).find("text.mp4: cannot be read as a video"),
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
