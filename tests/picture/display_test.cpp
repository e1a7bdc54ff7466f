// A display that answers late, or not at all.
#include "visualization/view/display.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <future>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "picture/picture_support.h"

namespace patina {
namespace {

using std::chrono::milliseconds;

// Servers search for a free number from 0 upwards: none comes this far.
int numberOfNone() {
  return 5000 + getpid() % 20000;
}

class DisplayOf {
 public:
  explicit DisplayOf(int number) : before_(std::getenv("DISPLAY")) {
    setenv("DISPLAY", (":" + std::to_string(number)).c_str(), 1);
  }
  ~DisplayOf() { setenv("DISPLAY", before_.c_str(), 1); }

 private:
  std::string before_;
};

TEST(RequireDisplay, ReportsASilentDisplayAfterItsTimeout) {
  PATINA_NEEDS_DISPLAY();
  const DisplayOf display(numberOfNone());
  const auto begin = std::chrono::steady_clock::now();
  try {
    requireDisplay(milliseconds(300));
    FAIL() << "no answer is possible yet";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("does not answer"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("xvfb-run"), std::string::npos);
  }
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(300));
}

TEST(RequireDisplay, WaitsForAServerThatIsStillStarting) {
  PATINA_NEEDS_DISPLAY();
  const int number = numberOfNone();
  const DisplayOf display(number);
  auto required = std::async(std::launch::async, [] { requireDisplay(std::chrono::seconds(30)); });
  EXPECT_EQ(required.wait_for(milliseconds(500)), std::future_status::timeout);
  test::XServer late(number);
  ASSERT_EQ(late.number(), number);
  EXPECT_NO_THROW(required.get());
}

TEST(OwnDisplay, ServersStartedTogetherHaveDifferentNumbers) {
  PATINA_NEEDS_DISPLAY();
  std::array<test::XServer, 6> servers;
  std::vector<int> numbers;
  for (test::XServer& each : servers) numbers.push_back(each.number().value_or(-1));
  std::sort(numbers.begin(), numbers.end());
  EXPECT_GE(numbers.front(), 0);
  EXPECT_EQ(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

} // namespace
} // namespace patina
