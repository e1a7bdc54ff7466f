// The servo thread after warm-up: no allocation, no lock, no page fault. Counted from inside, by
// stand-ins for the C library's entry points; sanitizers bring their own, so there this is left
// out.
#include <gtest/gtest.h>

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include <dlfcn.h>
#include <pthread.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "haptics/servo_loop.h"

namespace {
thread_local long allocations = 0;
thread_local long locks = 0;
using LockFunction = int (*)(pthread_mutex_t*);
std::atomic<LockFunction> real_lock{nullptr};
} // namespace

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  ++allocations;
  return __libc_realloc(block, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
void free(void* block) {
  if (block) ++allocations;
  __libc_free(block);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  ++locks;
  LockFunction lock = real_lock.load();
  if (!lock) {
    lock = reinterpret_cast<LockFunction>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
    real_lock.store(lock);
  }
  return lock(mutex);
}
}

namespace patina {
namespace {

struct Cost {
  long allocations = 0;
  long locks = 0;
  long page_faults = 0;
};

Cost costOfThisThread() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return {allocations, locks, usage.ru_minflt + usage.ru_majflt};
}

// Circles in and out of the sphere, so that contact, friction, its loss and the free path all run.
class CirclingDevice final : public Device {
 public:
  static constexpr int kWarmUp = 300;
  static constexpr int kTicks = 3000;

  DeviceState exchange(const Vec3&, double) noexcept override {
    if (tick_ == kWarmUp) before = costOfThisThread();
    if (tick_ == kTicks) {
      after = costOfThisThread();
      done.store(true);
    }
    const double angle = 0.01 * tick_++;
    const double r = 0.05 + 0.002 * std::sin(3.7 * angle);
    return {r * Vec3(std::cos(angle), std::sin(angle), 0.3 * std::sin(0.7 * angle)), false, false};
  }
  DeviceInfo info() const override { return {"circling", 0, 0, ""}; }

  Cost before, after;
  std::atomic<bool> done{false};

 private:
  int tick_ = 0;
};

TEST(ServoThread, NeitherAllocatesNorLocksNorFaultsAfterWarmUp) {
  const double radius = 0.05;
  FieldSpec spec;
  spec.resolution = 64;
  const FieldGrid grid = gridAround(Box3(Vec3::Constant(-radius), Vec3::Constant(radius)), spec);
  auto field = std::make_shared<const SurfaceField>(
      sampleFunction([=](const Vec3& p) { return p.norm() - radius; }, grid, spec.band));
  Scene scene;
  scene.haptics.friction = Friction{0.5, 0.3, 0.1, Friction::SlipDirection::paper};
  scene.haptics.damping = 1.0;
  auto owned = std::make_unique<CirclingDevice>();
  CirclingDevice& device = *owned;
  ServoLoop loop(std::move(owned), 5000);
  loop.publish(compileStages(scene, withSamples(field)));
  loop.start();
  for (int i = 0; i < 20000 && !device.done.load(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ToolSample sample;
    while (loop.samples().pop(sample)) {
    }
  }
  loop.stop();
  ASSERT_TRUE(device.done.load());
  EXPECT_EQ(device.after.allocations - device.before.allocations, 0);
  EXPECT_EQ(device.after.locks - device.before.locks, 0);
  EXPECT_EQ(device.after.page_faults - device.before.page_faults, 0);
}

TEST(ServoThread, IsWatchedByCountersThatDoCount) {
  const Cost before = costOfThisThread();
  const auto block = std::make_unique<char[]>(100000);
  std::mutex mutex;
  { const std::lock_guard guard(mutex); }
  const Cost after = costOfThisThread();
  EXPECT_GT(after.allocations, before.allocations);
  EXPECT_GT(after.locks, before.locks);
}

} // namespace
} // namespace patina

#endif
