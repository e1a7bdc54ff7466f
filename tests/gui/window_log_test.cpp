// The window's log is on disk while it runs, holds no memory, and quitting waits for no file.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/csv.h"
#include "core/file.h"
#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"
#include "gui/x_hand.h"
#include "integration/program.h"
#include "support/fresh_folder.h"
#include "support/places.h"
#include "support/resident.h"

namespace patina {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// Drags the tip along a circle until the end of its life.
class MovingHand {
 public:
  MovingHand() : thread_([this] { run(); }) {}
  ~MovingHand() {
    stops_ = true;
    thread_.join();
  }
  MovingHand(const MovingHand&) = delete;
  MovingHand& operator=(const MovingHand&) = delete;

 private:
  // The window manager puts a window into the middle of the screen, which has 2560 x 1600 pixels.
  static constexpr int kMiddle[2] = {1180, 760};

  void run() {
    test::XHand hand;
    // The drag begins again every second, for the first may come before the scene is loaded.
    for (double angle = 0; !stops_; angle += 0.05) {
      if (std::fmod(angle, 5) < 0.05) {
        hand.button(1, false);
        hand.moveTo(kMiddle[0], kMiddle[1]);
        hand.button(1, true);
      }
      hand.moveTo(kMiddle[0] + static_cast<int>(120 * std::cos(angle)),
                  kMiddle[1] + static_cast<int>(120 * std::sin(angle)));
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    hand.button(1, false);
  }
  std::atomic<bool> stops_{false};
  std::thread thread_;
};

class ChildWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!test::hasDisplay()) GTEST_SKIP() << "neither Xvfb nor DISPLAY";
    ASSERT_TRUE(test::hasWindowManager()) << "install openbox";
    folder_ = test::freshFolder("child");
    places_ = std::make_unique<test::Environment>(std::vector<std::pair<std::string, std::string>>{
        {"XDG_STATE_HOME", (folder_ / "state").string()},
        {"XDG_CONFIG_HOME", (folder_ / "config").string()}});
    writeMesh(folder_ / "sphere.obj", icosphere(30, 8));
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::unique_ptr<test::Running> start(const std::vector<std::string>& words) {
    auto child = std::make_unique<test::Running>(words, test::programFolder() / "patina-gui");
    const auto begin = Clock::now();
    while (!child->finished() && !child->catches(SIGTERM) && secondsSince(begin) < 60)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_TRUE(child->catches(SIGTERM)) << "the window has not opened";
    return child;
  }
  // Time of the last whole row; 0: none yet.
  static double lastTime(const fs::path& log) {
    std::ifstream file(log, std::ios::binary);
    file.seekg(0, std::ios::end);
    const auto size = static_cast<std::streamoff>(file.tellg());
    if (size <= 0) return 0;
    const auto part = std::min<std::streamoff>(size, 2000);
    std::string text(static_cast<std::size_t>(part), ' ');
    file.seekg(size - part);
    file.read(text.data(), part);
    const auto end = text.rfind('\n');
    if (end == std::string::npos || end == 0) return 0;
    return std::atof(text.c_str() + text.rfind('\n', end - 1) + 1);
  }
  // Seconds until the program has ended; fails after `most`.
  static double end(test::Running& child, double most) {
    const auto begin = Clock::now();
    while (!child.finished() && secondsSince(begin) < 30)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const double seconds = secondsSince(begin);
    std::printf("ended after %.2f s\n", seconds);
    EXPECT_LT(seconds, most);
    return seconds;
  }

  fs::path folder_;
  std::unique_ptr<test::Environment> places_;
};

TEST_F(ChildWindow, KilledWindowLosesAtMostTheLastSecondOfItsLog) {
  const fs::path log = folder_ / "log.csv";
  const auto child = start({"--log", log.string(), (folder_ / "sphere.obj").string()});
  const MovingHand hand;
  const auto begin = Clock::now();
  // The file lags behind the servo's clock, least right after a write.
  double lag = 1e9;
  while (secondsSince(begin) < 60 && (lastTime(log) < 5 || secondsSince(begin) < 6)) {
    if (const double t = lastTime(log); t > 1) lag = std::min(lag, secondsSince(begin) - t);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  child->signal(SIGKILL);
  const double lost = secondsSince(begin) - lag - lastTime(log);
  EXPECT_EQ(child->wait().exit, 128 + SIGKILL);
  std::printf("lost %.2f s\n", lost);
  EXPECT_LT(lost, 1);
  const CsvTable table = readCsv(log, {"t [s]", "x [m]"});
  ASSERT_GT(table.rows.size(), 1000U);
  double least = table.rows[0][1], most = least;
  for (std::size_t i = 1; i < table.rows.size(); ++i) {
    ASSERT_GT(table.rows[i][0], table.rows[i - 1][0]);
    least = std::min(least, table.rows[i][1]);
    most = std::max(most, table.rows[i][1]);
  }
  EXPECT_GT(most - least, 0.002) << "the tip moves";
}

// The long form takes twenty minutes.
TEST_F(ChildWindow, MemoryIsLevelWithALogAndAMovingTip) {
  const fs::path log = folder_ / "log.csv";
  const auto child = start({"--log", log.string(), (folder_ / "sphere.obj").string()});
  const double seconds = test::longSeconds(40, 1200);
  std::vector<std::size_t> resident;
  {
    const MovingHand hand;
    for (const auto begin = Clock::now(); secondsSince(begin) < seconds;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(250));
      resident.push_back(child->residentBytes());
    }
  }
  // 155 kB/s came when the log was in memory: 3 MB in half of 40 s.
  EXPECT_LT(test::growth(resident), 1.5e6);
  child->signal(SIGTERM);
  EXPECT_EQ(child->wait().exit, 0);
  EXPECT_GT(fs::file_size(log), static_cast<std::uintmax_t>(20000 * seconds));
}

TEST_F(ChildWindow, QuittingIsAtOnceWhileAFileIsRead) {
  ASSERT_EQ(mkfifo((folder_ / "slow.obj").c_str(), 0600), 0);
  const int writer = open((folder_ / "slow.obj").c_str(), O_RDWR | O_NONBLOCK); // it writes nothing
  ASSERT_GE(writer, 0);
  for (const bool by_key : {true, false}) {
    const auto child = start({(folder_ / "slow.obj").string()});
    std::this_thread::sleep_for(std::chrono::seconds(2));
    ASSERT_FALSE(child->finished());
    if (by_key) {
      test::XHand hand;
      hand.key(0xffe3, true); // Ctrl
      hand.key('q', true);
      hand.key('q', false);
      hand.key(0xffe3, false);
    } else {
      child->signal(SIGTERM);
    }
    end(*child, 2);
    const test::Outcome outcome = child->wait();
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
  }
  close(writer);
  EXPECT_TRUE(!fs::exists(folder_ / "state" / "patina") ||
              fs::is_empty(folder_ / "state" / "patina"));
}

TEST_F(ChildWindow, QuittingIsAtOnceWhileAScanIsRead) {
  fs::create_directory(folder_ / "scan");
  ASSERT_EQ(mkfifo((folder_ / "scan" / "frames.csv").c_str(), 0600), 0);
  const int writer = open((folder_ / "scan" / "frames.csv").c_str(), O_RDWR | O_NONBLOCK);
  ASSERT_GE(writer, 0);
  const auto child = start({(folder_ / "scan").string()});
  std::this_thread::sleep_for(std::chrono::seconds(2));
  ASSERT_FALSE(child->finished());
  child->signal(SIGTERM);
  end(*child, 2);
  EXPECT_EQ(child->wait().exit, 0);
  close(writer);
}

TEST_F(ChildWindow, LogIsWholeIfQuittingLeavesAReader) {
  ASSERT_EQ(mkfifo((folder_ / "slow.obj").c_str(), 0600), 0);
  const int writer = open((folder_ / "slow.obj").c_str(), O_RDWR | O_NONBLOCK);
  ASSERT_GE(writer, 0);
  const fs::path log = folder_ / "log.csv";
  const auto child = start({"--log", log.string(), (folder_ / "slow.obj").string()});
  std::this_thread::sleep_for(std::chrono::seconds(2));
  child->signal(SIGTERM);
  end(*child, 2);
  EXPECT_EQ(child->wait().exit, 0);
  EXPECT_TRUE(readFile(log).starts_with("t [s],x [m]"));
  close(writer);
}

} // namespace
} // namespace patina
