#include "field/face_block.h"

namespace patina {
namespace {

constexpr std::size_t kMostFaces = 256; // that a byte can name
constexpr std::size_t kSlots = 1024;    // of the hash table: a power of two, a quarter full at most

// Fibonacci hashing: neighbouring faces land far apart.
std::size_t slotOf(std::int32_t face) {
  return (static_cast<std::uint32_t>(face) * 2654435769U) >> 22;
}

} // namespace

FaceBlock::FaceBlock(const FaceNodes& nodes) {
  std::array<std::int16_t, kSlots> table;
  table.fill(-1);
  std::array<std::int32_t, kMostFaces> different;
  std::array<std::uint8_t, kBlockNodes> code;
  std::size_t count = 0;
  for (std::size_t node = 0; node < nodes.face.size(); ++node) {
    const std::int32_t face = nodes.face[node];
    if (node > 0 && face == nodes.face[node - 1]) {
      code[node] = code[node - 1];
      continue;
    }
    std::size_t slot = slotOf(face);
    while (table[slot] >= 0 && different[static_cast<std::size_t>(table[slot])] != face)
      slot = (slot + 1) % kSlots;
    if (table[slot] < 0) {
      if (count == kMostFaces) {
        faces_.assign(nodes.face.begin(), nodes.face.end());
        return;
      }
      different[count] = face;
      table[slot] = static_cast<std::int16_t>(count++);
    }
    code[node] = static_cast<std::uint8_t>(table[slot]);
  }
  faces_.assign(different.begin(), different.begin() + static_cast<std::ptrdiff_t>(count));
  code_.assign(code.begin(), code.end());
}

FaceBlock::FaceBlock(const FaceBlock& block, std::int32_t offset)
    : faces_(block.faces_), code_(block.code_) {
  for (std::int32_t& face : faces_)
    if (face >= 0) face += offset;
}

} // namespace patina
