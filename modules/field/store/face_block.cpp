#include "field/store/face_block.h"

#include <algorithm>
#include <cstring>

namespace patina {
namespace {

constexpr std::size_t kSlots = 1024; // size of the hash table: a power of two, at most half full
constexpr std::uint16_t kNoFace = 0xFFFF;
constexpr std::uint32_t kAxisOrders[] = {0x30, 0x60, 0x03, 0x63, 0x06, 0x36};

// Fibonacci hashing: neighbouring faces get distant slots.
std::size_t slotOf(std::int32_t face) {
  return (static_cast<std::uint32_t>(face) * 2654435769U) >> 22;
}

} // namespace

FaceBlock::FaceBlock(const FaceNodes& nodes) {
  std::array<std::int16_t, kSlots> table;
  table.fill(-1);
  std::array<std::int32_t, kBlockNodes> different;
  std::array<std::uint16_t, kBlockNodes> code;
  std::int32_t highest = -1;
  std::uint32_t count = 0;
  lowest_ = -1;
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
      different[count] = face;
      table[slot] = static_cast<std::int16_t>(count++);
      highest = std::max(highest, face);
      if (face >= 0 && (lowest_ < 0 || face < lowest_)) lowest_ = face;
    }
    code[node] = static_cast<std::uint16_t>(table[slot]);
  }
  lowest_ = std::max(lowest_, 0);
  wide_ = highest - lowest_ >= kNoFace ? 1U : 0U;
  faces_ = count & 0x3FFU;
  bits_ = static_cast<unsigned>(std::bit_width(count - 1)) & 0xFU;

  std::array<std::uint16_t, kBlockNodes> walked;
  std::array<std::uint16_t, kBlockNodes> best;
  unsigned fewest = kBlockNodes + 1;
  for (const std::uint32_t axis_order : kAxisOrders) {
    for (std::size_t node = 0; node < code.size(); ++node)
      walked[stepOf(node, axis_order)] = code[node];
    unsigned runs = 1;
    for (std::size_t step = 1; step < walked.size(); ++step)
      runs += walked[step] != walked[step - 1];
    if (runs >= fewest) continue;
    fewest = runs;
    axis_order_ = axis_order & 0x7FU;
    best = walked;
  }
  runs_ = fewest & 0x3FFU;

  data_ = std::make_unique<std::uint8_t[]>(dataBytes());
  for (std::size_t i = 0; i < faces_; ++i) {
    const auto above = static_cast<std::uint32_t>(different[i] - lowest_);
    const std::uint32_t wide = different[i] < 0 ? 0xFFFFFFFFU : above;
    const auto narrow = static_cast<std::uint16_t>(wide);
    if (wide_)
      std::memcpy(data_.get() + 4 * i, &wide, sizeof wide);
    else
      std::memcpy(data_.get() + 2 * i, &narrow, sizeof narrow);
  }
  std::uint8_t* codes = data_.get() + faces_ * faceBytes();
  std::size_t bit = 0;
  for (std::size_t step = 0; step < best.size(); ++step) {
    if (step > 0 && best[step] == best[step - 1]) continue;
    starts_[step / 64] |= std::uint64_t{1} << step % 64;
    if (bits_ == 0) continue;
    const auto shifted = static_cast<unsigned>(best[step]) << bit % 8;
    codes[bit / 8] = static_cast<std::uint8_t>(codes[bit / 8] | shifted);
    codes[bit / 8 + 1] = static_cast<std::uint8_t>(codes[bit / 8 + 1] | shifted >> 8);
    bit += bits_;
  }
}

FaceBlock::FaceBlock(const FaceBlock& block, std::int32_t offset)
    : starts_(block.starts_), data_(std::make_unique<std::uint8_t[]>(block.dataBytes())),
      lowest_(block.lowest_ + offset), faces_(block.faces_), runs_(block.runs_), bits_(block.bits_),
      axis_order_(block.axis_order_), wide_(block.wide_) {
  std::memcpy(data_.get(), block.data_.get(), block.dataBytes());
}

std::int32_t FaceBlock::face(std::size_t code) const {
  if (wide_) {
    std::uint32_t above;
    std::memcpy(&above, data_.get() + 4 * code, sizeof above);
    return above == 0xFFFFFFFFU ? -1 : lowest_ + static_cast<std::int32_t>(above);
  }
  std::uint16_t above;
  std::memcpy(&above, data_.get() + 2 * code, sizeof above);
  return above == kNoFace ? -1 : lowest_ + above;
}

} // namespace patina
