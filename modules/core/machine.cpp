#include <array>
#include <sched.h>
#include <stdlib.h>
#include <string>
#include <sys/utsname.h>
#include <thread>

#include "core/error.h"
#include "core/file.h"
#include "core/utc_time.h"
#include "core/work_precision.h"

namespace patina {
namespace {

std::string processorName() {
  try {
    const std::string text = readFile("/proc/cpuinfo");
    const std::size_t at = text.find("model name");
    if (at != std::string::npos) {
      const std::size_t begin = text.find(": ", at);
      const std::size_t end = text.find('\n', at);
      if (begin < end && end != std::string::npos) return text.substr(begin + 2, end - begin - 2);
    }
  } catch (const Error&) { // the table stays useful without the name
  }
  return "unknown";
}

std::string policyName() {
  sched_param parameters{};
  sched_getparam(0, &parameters);
  const std::string priority = " " + std::to_string(parameters.sched_priority);
  switch (sched_getscheduler(0)) {
  case SCHED_OTHER:
    return "SCHED_OTHER";
  case SCHED_FIFO:
    return "SCHED_FIFO" + priority;
  case SCHED_RR:
    return "SCHED_RR" + priority;
  case SCHED_BATCH:
    return "SCHED_BATCH";
  case SCHED_IDLE:
    return "SCHED_IDLE";
  default:
    return "unknown";
  }
}

} // namespace

Json machineDescription() {
  Json json = Json::object();
  json.set("processor", processorName());
  json.set("cores", static_cast<std::int64_t>(std::thread::hardware_concurrency()));
  utsname system{};
  if (uname(&system) == 0)
    json.set("system", std::string(system.sysname) + " " + system.release + " " + system.machine);
#if defined(__clang__)
  json.set("compiler", "clang " __clang_version__);
#else
  json.set("compiler", "gcc " __VERSION__);
#endif
  json.set("flags", PATINA_COMPILE_FLAGS);
  json.set("policy", policyName());
  std::array<double, 3> load{};
  if (getloadavg(load.data(), 3) == 3)
    json.set("load", Json::Array{Json(load[0]), Json(load[1]), Json(load[2])});
  json.set("date", formatUtc(utcSeconds()));
  return json;
}

} // namespace patina
