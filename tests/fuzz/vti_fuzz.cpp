// Any bytes give a field or a volume with finite limits, or a FileError.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

#include "core/error.h"
#include "visualization/files/field_io.h"

// VTK asks for what a damaged block claims, and the program reports that there is no such memory;
// the sanitizer would end it.
void* operator new[](std::size_t size) {
  constexpr std::size_t kMost = std::size_t{1} << 30;
  void* const got = size <= kMost ? std::malloc(size) : nullptr;
  if (got == nullptr) throw std::bad_alloc();
  return got;
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

// VTK does not free the iterator of an array that it cannot read.
extern "C" int __lsan_is_turned_off() {
  return 1;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("fuzz", 0); // VTK reads by name
  if (ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size))
    std::abort();
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  try {
    if (patina::isField(path)) {
      const patina::SurfaceField field = patina::readField(path);
      for (const auto& block : field.distance)
        for (const float phi : block->phi())
          if (!std::isfinite(phi)) __builtin_trap();
    }
    (void)patina::scalarRange(path);
  } catch (const patina::FileError&) {
  }
  return 0;
}
