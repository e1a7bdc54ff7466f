// The servo thread after warm-up: no allocation, no lock, no page fault. Replacements of the C
// library's entry points count them; sanitizers bring their own, so their builds skip this test.
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

#include "field/construction/build_field.h"
#include "geometry/mesh/shapes.h"
#include "haptics/servo/servo_loop.h"

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
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  ++allocations;
  *block = __libc_memalign(alignment, size);
  return *block ? 0 : 12;
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

// In and out of a solid block with a thin fin, deep into the block, through the fin in one tick,
// off the grid and back: the path covers contact, friction, deep contact, a fault and free motion.
class WanderingDevice final : public Device {
 public:
  static constexpr int kWarmUp = 500;
  static constexpr int kTicks = 6000;

  DeviceState exchange(const Vec3&, double) noexcept override {
    if (tick_ == kWarmUp) before = costOfThisThread();
    if (tick_ == kTicks) {
      after = costOfThisThread();
      done.store(true);
    }
    return {place(tick_++ % 1000)};
  }

  Cost before, after;
  std::atomic<bool> done{false};

 private:
  static Vec3 place(int phase) noexcept {
    const double s = phase * 1e-3;
    if (phase < 400) return Vec3(0.01 * std::sin(40 * s), 0, 0.021 - 0.003 * s);
    if (phase < 600) return Vec3(0, 0, 0.02 - 0.05 * (s - 0.4));
    if (phase < 700) return Vec3(0.03 + 2e-3 * (phase % 2), 0.001, 0.002);
    if (phase < 750) return Vec3(1, 1, 1);
    if (phase < 760) return Vec3::Constant(std::nan(""));
    return Vec3(0, 0, phase % 2 ? 0.05 : 0.015);
  }

  int tick_ = 0;
};

TEST(ServoThread, NeitherAllocatesNorLocksNorFaultsAfterWarmUp) {
  const TriangleMesh fin = transformed(box(Vec3(0.0005, 0.02, 0.02)),
                                       Eigen::Affine3d(Eigen::Translation3d(0.031, 0, 0)));
  FieldSpec spec;
  spec.resolution = 100;
  Progress progress;
  const auto field =
      withSamples(buildField(joined(box(Vec3::Constant(0.04), 4), fin), spec, progress).field);
  Scene scene;
  scene.haptics.friction = Friction{0.5, 0.3, 0.1, Friction::SlipDirection::paper};
  scene.haptics.damping = 1.0;
  auto owned = std::make_unique<WanderingDevice>();
  WanderingDevice& device = *owned;
  ServoLoop loop(std::move(owned), 5000);
  loop.publish(compileStages(scene, field));
  loop.start();
  bool contact = false, fault = false;
  for (int i = 0; i < 20000 && !device.done.load(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (i % 100 == 50) {
      scene.haptics.stiffness = 500 + i % 7;
      loop.publish(compileStages(scene, field));
    }
    ToolSample sample;
    while (loop.samples().pop(sample)) {
      contact |= sample.contact;
      fault |= sample.fault;
    }
  }
  loop.stop();
  ASSERT_TRUE(device.done.load());
  EXPECT_TRUE(contact && fault) << contact << fault;
  EXPECT_EQ(device.after.allocations - device.before.allocations, 0);
  EXPECT_EQ(device.after.locks - device.before.locks, 0);
  EXPECT_EQ(device.after.page_faults - device.before.page_faults, 0);
}

TEST(ServoThread, IsWatchedByWorkingCounters) {
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
