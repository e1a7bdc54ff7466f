// Two threads; also run under ThreadSanitizer by tests/run.sh.
#include "core/snapshot_exchange.h"

#include <thread>

namespace patina {
namespace {

struct Value {
  explicit Value(int n) : number(n), twice(2 * n) { ++alive; }
  ~Value() {
    number = -1;
    --alive;
  }
  Value(const Value&) = delete;
  static inline std::atomic<int> alive{0};
  int number;
  int twice;
};

TEST(SnapshotExchange, ReturnsNothingBeforeTheFirstAndThenTheNewest) {
  SnapshotExchange<Value> exchange;
  EXPECT_EQ(exchange.latest(), nullptr);
  exchange.publish(std::make_shared<const Value>(1));
  exchange.publish(std::make_shared<const Value>(2));
  ASSERT_NE(exchange.latest(), nullptr);
  EXPECT_EQ(exchange.latest()->number, 2);
}

TEST(SnapshotExchange, KeepsTheValueOfTheReaderAndFreesTheRest) {
  {
    SnapshotExchange<Value> exchange;
    exchange.publish(std::make_shared<const Value>(1));
    const Value* held = exchange.latest();
    for (int i = 2; i < 10; ++i) exchange.publish(std::make_shared<const Value>(i));
    EXPECT_EQ(held->number, 1); // freed memory would hold -1, or trip the sanitizer
    EXPECT_EQ(Value::alive, 2);
    EXPECT_EQ(exchange.latest()->number, 9);
    EXPECT_EQ(exchange.collect(), 1u);
    EXPECT_EQ(Value::alive, 1);
  }
  EXPECT_EQ(Value::alive, 0);
}

TEST(SnapshotExchange, SharedValuesOutliveTheExchange) {
  const auto mine = std::make_shared<const Value>(5);
  {
    SnapshotExchange<Value> exchange;
    exchange.publish(mine);
    exchange.publish(std::make_shared<const Value>(6));
  }
  EXPECT_EQ(mine->number, 5);
}

TEST(SnapshotExchange, ReaderNeverSeesAFreedOrOlderValue) {
  constexpr int kCount = 20000;
  {
    SnapshotExchange<Value> exchange;
    std::atomic<bool> done{false};
    std::atomic<int> faults{0};
    std::thread reader([&] {
      int last = 0;
      while (!done) {
        const Value* value = exchange.latest();
        if (!value) continue;
        if (value->number < last || value->twice != 2 * value->number) ++faults;
        last = value->number;
      }
    });
    std::size_t most = 0;
    for (int i = 1; i <= kCount; ++i) {
      exchange.publish(std::make_shared<const Value>(i));
      most = std::max(most, exchange.collect());
    }
    done = true;
    reader.join();
    EXPECT_EQ(faults, 0);
    EXPECT_LE(most, 2u); // the newest and the one in use: an endless edit needs no more memory
  }
  EXPECT_EQ(Value::alive, 0);
}

TEST(SnapshotExchange, ProtectedValueOutlivesLaterValues) {
  SnapshotExchange<Value> exchange;
  exchange.publish(std::make_shared<const Value>(1));
  const Value* held = exchange.latest();
  exchange.protect(held);
  for (int i = 2; i < 10; ++i) {
    exchange.publish(std::make_shared<const Value>(i));
    EXPECT_EQ(exchange.latest()->number, i);
  }
  EXPECT_EQ(held->number, 1);
  exchange.protect(nullptr);
  EXPECT_EQ(exchange.collect(), 1u);
}

// A cross-fade protects the old value while it uses the next one.
TEST(SnapshotExchange, ReaderOfTwoValuesNeverSeesAFreedOne) {
  {
    SnapshotExchange<Value> exchange;
    std::atomic<bool> done{false};
    std::atomic<int> faults{0};
    std::thread reader([&] {
      const Value* old = nullptr;
      while (!done) {
        exchange.protect(old);
        const Value* next = exchange.latest();
        for (const Value* value : {old, next})
          if (value && value->twice != 2 * value->number) ++faults;
        old = next;
      }
    });
    std::size_t most = 0;
    for (int i = 1; i <= 20000; ++i) {
      exchange.publish(std::make_shared<const Value>(i));
      most = std::max(most, exchange.collect());
    }
    done = true;
    reader.join();
    EXPECT_EQ(faults, 0);
    EXPECT_LE(most, 3u);
  }
  EXPECT_EQ(Value::alive, 0);
}

} // namespace
} // namespace patina
