// A plug-in in the test's own program: it notes each exchange, and fails on request, from the next
// exchange on.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <thread>

#include "haptics/device/realtime.h"
#include "haptics/plugin/plugin_device.h"
#include "haptics/plugin/plugin_library.h"

namespace patina::test {

enum class Fault {
  none,
  stalls,
  answers_nan,
  answers_infinity,
  leaves_it_out,
  refuses,
  turns_wrongly,
  is_far,
  odd_status,
  negative_age,
  old_age,
  is_gone,
  calibrates,
  throws,
  hangs,
  slow
};
struct Noted {
  double force;    // [N], magnitude
  std::int64_t at; // [ns]
  Fault fault;     // in force
};
inline struct Faulty {
  std::atomic<Fault> fault{Fault::none};
  std::atomic<int> calls{0}, closed{0};
  std::atomic<double> left{0}; // [N], largest force requested right before a close
  std::array<Noted, 20000> noted;
  std::atomic<bool> release{false};
} faulty;

inline void* openFaulty(const char* argument, char* why, std::size_t room) {
  if (std::strcmp(argument, "refuse") == 0) {
    std::memset(why, 'x', room); // without a final zero
    return nullptr;
  }
  if (std::strcmp(argument, "throw") == 0) throw 7;
  return &faulty;
}

inline int exchangeFaulty(void*, const double force[3], double, patina_device_state* state) {
  const int call = faulty.calls;
  const Fault fault = faulty.fault;
  if (call < 20000)
    faulty.noted[static_cast<std::size_t>(call)] = {Vec3(force[0], force[1], force[2]).norm(),
                                                    monotonicNs(), fault};
  ++faulty.calls;
  for (int i = 0; i < 3; ++i) state->position[i] = 1e-3 * (i + 1);
  switch (fault) {
  case Fault::stalls:
    for (int i = 0; i < 60 && !faulty.release; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    faulty.fault = Fault::none;
    break;
  case Fault::hangs:
    while (!faulty.release) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    break;
  case Fault::slow:
    std::this_thread::sleep_for(std::chrono::milliseconds(8));
    break;
  case Fault::answers_nan:
    state->position[1] = std::nan("");
    break;
  case Fault::answers_infinity:
    state->has_velocity = 1;
    state->velocity[2] = INFINITY;
    break;
  case Fault::leaves_it_out:
    for (double& place : state->position) place = std::nan("");
    break;
  case Fault::refuses:
    return -1;
  case Fault::turns_wrongly:
    state->orientation[0] = 0;
    break;
  case Fault::is_far:
    state->position[0] = 1e6;
    break;
  case Fault::odd_status:
    state->status = 77;
    break;
  case Fault::negative_age:
    state->age = -1;
    break;
  case Fault::old_age:
    state->age = 0.5;
    break;
  case Fault::is_gone:
    state->status = PATINA_DEVICE_GONE;
    break;
  case Fault::calibrates:
    state->status = PATINA_DEVICE_CALIBRATING;
    break;
  case Fault::throws:
    throw std::runtime_error("no plug-in may");
  case Fault::none:
    break;
  }
  return 0;
}

inline void describeFaulty(patina_device_description* description) {
  std::memset(description->name, 'N', sizeof description->name); // fills its room
  description->max_force = 3;
  description->max_stiffness = std::nan("");
  description->workspace_low[0] = 1; // above the highest
}

inline void closeFaulty(void*) {
  if (const int calls = faulty.calls; calls > 0 && calls <= 20000)
    faulty.left =
        std::max<double>(faulty.left, faulty.noted[static_cast<std::size_t>(calls - 1)].force);
  ++faulty.closed;
}

inline const patina_device kFaulty{PATINA_DEVICE_ABI, sizeof(patina_device), describeFaulty,
                                   openFaulty,        exchangeFaulty,        closeFaulty};

inline std::unique_ptr<Device> makeFaulty(const char* argument,
                                          std::shared_ptr<LinkStatistics> notes) {
  faulty.fault = Fault::none;
  faulty.calls = 0;
  faulty.closed = 0;
  faulty.left = 0;
  faulty.release = false;
  return makeLinkedDevice(
      makePluginLink(kFaulty, argument),
      {.guard = guardFor(described("faulty", kFaulty).limits), .notes = std::move(notes)});
}

} // namespace patina::test
