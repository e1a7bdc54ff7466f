// Two threads; also run under ThreadSanitizer by tests/run.sh.
#include "core/ring.h"

#include <thread>

namespace patina {
namespace {

struct Item {
  std::uint64_t number = 0;
  std::uint64_t check = 0; // ~number reveals a torn item
};

TEST(Ring, RoundsCapacityUpAndDropsTheNewest) {
  Ring<int> ring(3);
  EXPECT_EQ(ring.capacity(), 4u);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(ring.push(i), i < 4);
  EXPECT_EQ(ring.dropped(), 2u);
  int out = -1;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(ring.pop(out));
    EXPECT_EQ(out, i);
  }
  EXPECT_FALSE(ring.pop(out));
}

TEST(Ring, WrapsAroundManyTimes) {
  Ring<int> ring(4);
  int out = -1;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(ring.push(i));
    ASSERT_TRUE(ring.pop(out));
    ASSERT_EQ(out, i);
  }
}

TEST(Ring, TwoThreadsLoseReorderAndTearNothing) {
  constexpr std::uint64_t kCount = 100000;
  Ring<Item> ring(64);
  std::thread producer([&] {
    for (std::uint64_t i = 0; i < kCount; ++i)
      while (!ring.push({i, ~i})) std::this_thread::yield();
  });
  Item item;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    while (!ring.pop(item)) std::this_thread::yield();
    if (item.number != i || item.check != ~i) {
      ADD_FAILURE() << "item " << i << " is " << item.number;
      break;
    }
  }
  // A failed loop must still let the producer end.
  while (ring.pop(item) || item.number + 1 < kCount) std::this_thread::yield();
  producer.join();
}

TEST(Ring, DroppedAndReceivedAddUpWhenTheConsumerIsSlow) {
  constexpr std::uint64_t kCount = 50000;
  Ring<Item> ring(16);
  std::atomic<bool> done{false};
  std::thread producer([&] {
    for (std::uint64_t i = 0; i < kCount; ++i) ring.push({i, ~i});
    done = true;
  });
  std::uint64_t received = 0, last = 0;
  Item item;
  for (;;) {
    const bool ended = done;
    if (ring.pop(item)) {
      EXPECT_TRUE(received == 0 || item.number > last);
      last = item.number;
      ++received;
    } else if (ended) {
      break;
    }
  }
  producer.join();
  EXPECT_EQ(received + ring.dropped(), kCount);
}

} // namespace
} // namespace patina
