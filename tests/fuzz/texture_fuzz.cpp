// Any bytes give a texture that can be rendered, or a FileError.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"
#include "workspace/texture_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  std::optional<patina::FourierTexture> texture;
  try {
    texture = patina::parseTexture(bytes, "fuzz");
  } catch (const patina::FileError&) {
  }
  if (texture && (!patina::problemOf(*texture).empty() ||
                  !(patina::parseTexture(patina::textureText(*texture), "again") == *texture)))
    __builtin_trap();
  std::string laid;
  try {
    laid = patina::laidTexturesText(patina::parseLaidTextures(bytes, "fuzz"));
  } catch (const patina::FileError&) {
    return 0;
  }
  if (patina::laidTexturesText(patina::parseLaidTextures(laid, "again")) != laid) __builtin_trap();
  return 0;
}
