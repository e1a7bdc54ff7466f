// The header of a PLY file. Internal to the reader.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace patina {

enum class PlyFormat { ascii, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t bytes(PlyType type);
inline bool isInteger(PlyType type) {
  return type != PlyType::float32 && type != PlyType::float64;
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> count_type; // set for a list; always an integer type
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::size_t line = 0; // where the header declares it
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> pictures; // of comment TextureFile
  std::string_view body;             // what follows the header
  std::size_t lines = 0;             // of the header
  std::size_t body_byte = 0;         // offset of the body in the file
};

// Throws FileError. Every element's count is one that the body could hold, so that memory may be
// reserved by it.
PlyHeader parsePlyHeader(std::string_view bytes, const std::string& name);

} // namespace patina
