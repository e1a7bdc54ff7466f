// Painted quantities of a picture, with colours and ranges.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

#include "scene/color_scale.h"
#include "scene/scene.h"

namespace patina {

// One is shown at a time. Material channels are in the order of MaterialChannel.
enum class PaintQuantity : std::uint8_t {
  color,  // over the object's own colour, with shaded relief
  relief, // height as colour, with shaded relief
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

// Returns true if the object, or any object, has this paint. Colour includes relief.
bool hasPaint(const SceneObject& object, PaintQuantity quantity);
bool hasPaint(const Scene& scene, PaintQuantity quantity);

// Names of arrays in files: "color", "relief [m]", "stiffness [N/m]", "friction.static" ...
std::string arrayName(PaintQuantity quantity);

// Smallest range with round ends and quarters that contains this one; never empty.
ValueRange rounded(const ValueRange& range);

// Relief: diverging, pale at 0 in any range. Material: sequential, dark is high. Both are
// perceptually uniform. Range in SI.
vtkSmartPointer<vtkLookupTable> paintColors(PaintQuantity quantity, const ValueRange& range);

// Title and factor of a scalar bar: heights and roughness are shown in mm or micrometres.
struct ReadingUnit {
  std::string title;
  double display_per_si = 1;
};
ReadingUnit readingUnit(PaintQuantity quantity, const ValueRange& range);

} // namespace patina
