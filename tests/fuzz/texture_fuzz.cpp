// Whatever the bytes: a texture that can be felt, or a FileError.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/error.h"
#include "workspace/texture_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const patina::FourierTexture texture = patina::parseTexture(bytes, "fuzz");
    if (!patina::problemOf(texture).empty()) __builtin_trap();
    if (!(patina::parseTexture(patina::textureText(texture), "again") == texture)) __builtin_trap();
  } catch (const patina::FileError&) {
  }
  try {
    patina::parseLaidTextures(bytes, "fuzz");
  } catch (const patina::FileError&) {
  }
  return 0;
}
