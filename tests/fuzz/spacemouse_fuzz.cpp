// Whatever a SpaceMouse reports, a report after its length: a cap of finite, bounded counts.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "haptics/devices/spacemouse/spacemouse.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  patina::CapState cap;
  std::size_t at = 0;
  while (at < size) {
    const std::size_t length = std::min<std::size_t>(data[at] & 0x3f, size - at - 1);
    const patina::CapState before = cap;
    const auto* report = reinterpret_cast<const std::byte*>(data + at + 1);
    const bool taken = patina::takeReport({report, length}, cap);
    if (!taken &&
        (cap.shift != before.shift || cap.turn != before.turn || cap.buttons != before.buttons))
      std::abort();
    if (!(cap.shift.lpNorm<Eigen::Infinity>() <= 500 && cap.turn.lpNorm<Eigen::Infinity>() <= 500))
      std::abort();
    at += 1 + length;
  }
  return 0;
}
