#include "scene/slice_position.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr std::string_view kAxisNames = "xyz";

[[noreturn]] void refuseDirection(std::string_view text) {
  throw Error("'" + std::string(text) + "' is no direction: x, -x, y, -y, z, -z or as 0,1,1");
}

Vec3 parseDirection(std::string_view text) {
  const bool reversed = text.starts_with('-');
  const auto axis =
      text.size() == (reversed ? 2U : 1U) ? kAxisNames.find(text.back()) : std::string_view::npos;
  if (axis != std::string_view::npos)
    return (reversed ? -1 : 1) * Vec3::Unit(static_cast<int>(axis));
  Vec3 direction;
  std::string_view rest = text;
  for (int i = 0; i < 3; ++i) {
    const auto comma = rest.find(',');
    if ((comma == std::string_view::npos) != (i == 2)) refuseDirection(text);
    std::string_view cell = rest.substr(0, comma);
    while (cell.starts_with(' ')) cell.remove_prefix(1);
    const auto number = parseNumber(cell);
    if (!number) refuseDirection(text);
    direction[i] = *number;
    if (i < 2) rest.remove_prefix(comma + 1);
  }
  const double length = direction.norm();
  if (!(length > 0 && std::isfinite(length))) refuseDirection(text);
  return std::abs(length - 1) < 1e-12 ? direction : Vec3(direction / length);
}

} // namespace

SlicePosition parseSlice(std::string_view text) {
  SlicePosition slice;
  const auto colon = text.find(':');
  slice.normal = parseDirection(text.substr(0, colon));
  if (colon != std::string_view::npos) slice.position = parseLength(text.substr(colon + 1));
  if (slice.position && !std::isfinite(*slice.position))
    throw Error("'" + std::string(text) + "': the position must be finite");
  return slice;
}

std::string directionText(const Vec3& normal) {
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(normal[axis]) == 1)
      return (normal[axis] < 0 ? "-" : "") +
             std::string(1, kAxisNames[static_cast<std::size_t>(axis)]);
  std::array<char, 64> text{};
  // Adding 0 avoids -0.
  std::snprintf(text.data(), text.size(), "%.4g, %.4g, %.4g", normal.x() + 0.0, normal.y() + 0.0,
                normal.z() + 0.0);
  return text.data();
}

std::string format(const SlicePosition& slice) {
  const Vec3& n = slice.normal;
  std::string text = directionText(n);
  if (text.find(',') != std::string::npos)
    text = formatNumber(n.x()) + "," + formatNumber(n.y()) + "," + formatNumber(n.z());
  return text + (slice.position ? ":" + formatNumber(*slice.position) : "");
}

} // namespace patina
