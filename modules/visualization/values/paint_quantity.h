// What of the paint a picture shows, in which colours and over which range.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

#include "scene/scene.h"

namespace patina {

// One at a time. The material's are in the order of MaterialChannel.
enum class PaintQuantity : std::uint8_t {
  color,  // as painted, over the object's own colour, with relief seen as relief
  relief, // height as colour, and seen as relief
  first_channel
};
inline constexpr std::size_t kFirstChannel = static_cast<std::size_t>(PaintQuantity::first_channel);
inline constexpr std::size_t kPaintQuantities = kFirstChannel + kMaterialChannels;

constexpr std::optional<MaterialChannel> channelOf(PaintQuantity quantity) {
  if (quantity < PaintQuantity::first_channel) return std::nullopt;
  return static_cast<MaterialChannel>(static_cast<std::size_t>(quantity) - kFirstChannel);
}
constexpr PaintQuantity quantityOf(MaterialChannel channel) {
  return static_cast<PaintQuantity>(static_cast<std::size_t>(channel) + kFirstChannel);
}

// Whether an object, or any object of a scene, has some of it painted. Relief is seen in colour,
// too.
bool hasPaint(const SceneObject& object, PaintQuantity quantity);
bool hasPaint(const Scene& scene, PaintQuantity quantity);

// As arrays in files are called: "color", "relief [m]", "stiffness [N/m]", "friction.static" ...
std::string arrayName(PaintQuantity quantity);

struct ValueRange {
  double low = 0, high = 1; // SI
  bool operator==(const ValueRange&) const = default;
};

// The least range with round ends and quarters that holds both ends of this one; never empty.
ValueRange rounded(const ValueRange& range);

// Relief: diverging, its pale middle at 0 whatever the range. Material: sequential, dark is much.
// Perceptually even, both. Range in SI.
vtkSmartPointer<vtkLookupTable> paintColors(PaintQuantity quantity, const ValueRange& range);

// Title and factor of a scalar bar: heights and roughness are read in mm or micrometres.
struct ReadingUnit {
  std::string title;
  double per_si = 1;
};
ReadingUnit readingUnit(PaintQuantity quantity, const ValueRange& range);

} // namespace patina
