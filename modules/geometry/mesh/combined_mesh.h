// Several meshes combined into one: the faces of each follow those of the one before.
#pragma once

#include <algorithm>
#include <cstdint>
#include <ranges>

namespace patina {

// Returns the index of the object that a face of the combined mesh belongs to, or -1 for -1.
// firstOf(object) is its first face, which ascends.
template <class Parts, class FirstOf>
std::int32_t objectOfFace(const Parts& parts, std::int32_t face, FirstOf firstOf) noexcept {
  if (face < 0) return -1;
  const auto next = std::ranges::upper_bound(parts, face, {}, firstOf);
  return static_cast<std::int32_t>(next - std::ranges::begin(parts)) - 1;
}

} // namespace patina
