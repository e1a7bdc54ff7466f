// Channels of painted material: the one list for files, brushes, panels, reports and the servo's
// reader.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/types.h"

namespace patina {

// Material at one point, SI. Its members are all channels, in the order of kChannels.
struct Material {
  double stiffness = 500;      // K [N/m]
  double static_friction = 0;  // mu_s
  double dynamic_friction = 0; // mu_d
  double damping = 0;          // B [N s/m]
  double roughness = 0;        // [m], rms height of a fine pattern
  bool operator==(const Material&) const = default;
};

// Gradients of the composited values at a point, of the trilinear interpolant, in the world; zero
// for unpainted channels.
struct MaterialGradients {
  Vec3 stiffness = Vec3::Zero(); // [N/m^2]
  Vec3 roughness = Vec3::Zero(); // dimensionless
};

enum class MaterialChannel : std::uint8_t {
  stiffness,
  static_friction,
  dynamic_friction,
  damping,
  roughness
};

struct MaterialRange {
  double min, max;
};

// Unit of the display and its scale.
struct DisplayUnit {
  std::string_view unit; // UTF-8
  double display_per_si;
  int decimals;
};
struct SliderRange { // values of the brush panel, in the display unit
  double min, max, step;
  int decimals;
  bool logarithmic;
};

struct Channel {
  MaterialChannel channel;
  double Material::*value;
  std::string_view key, unit;         // keys of files; unit in SI, "" = ratio
  MaterialRange range;                // SI, allowed in a scene: 0 or more
  double default_value;               // SI, initial value of a brush
  std::string_view caption;           // "static friction"
  std::string_view tool;              // tool button; channels of one tool are adjacent and share it
  std::string_view dial_caption, tip; // caption of the value; tooltip of the tool
  DisplayUnit reading;
  SliderRange dial;
};

// clang-format off
inline constexpr std::array kChannels{
    Channel{MaterialChannel::stiffness, &Material::stiffness, "stiffness", "N/m", {0, 1e7}, 1250,
            "stiffness", "stiffness", "Stiffness", "Make places softer or harder",
            {"N/m", 1, 0}, {10, 10000, 10, 0, true}},
    Channel{MaterialChannel::static_friction, &Material::static_friction, "friction.static", "", {0, 10}, 0.8,
            "static friction", "friction", "Coefficient", "Make places slippery or grippy, static and dynamic",
            {"", 1, 3}, {0, 2, 0.05, 2, false}},
    Channel{MaterialChannel::dynamic_friction, &Material::dynamic_friction, "friction.dynamic", "", {0, 10}, 0.5,
            "dynamic friction", "friction", "Coefficient", "Make places slippery or grippy, static and dynamic",
            {"", 1, 3}, {0, 2, 0.05, 2, false}},
    Channel{MaterialChannel::damping, &Material::damping, "damping", "N s/m", {0, 1e4}, 3,
            "damping", "damping", "Damping", "Make places viscous",
            {"N s/m", 1, 2}, {0, 20, 0.1, 2, false}},
    Channel{MaterialChannel::roughness, &Material::roughness, "roughness", "m", {0, 1e-3}, 5e-5,
            "roughness", "roughness", "Roughness, rms", "Give places a fine rough pattern",
            {"\xC2\xB5m", 1e6, 1}, {0, 500, 5, 0, false}}};
// clang-format on
inline constexpr std::size_t kMaterialChannels = kChannels.size();
inline constexpr auto kAllMaterialChannels = [] {
  std::array<MaterialChannel, kMaterialChannels> all{};
  std::transform(kChannels.begin(), kChannels.end(), all.begin(),
                 [](const Channel& row) { return row.channel; });
  return all;
}();

constexpr const Channel& rowOf(MaterialChannel channel) {
  return kChannels[static_cast<std::size_t>(channel)];
}
static_assert(std::all_of(kChannels.begin(), kChannels.end(),
                          [](const Channel& row) { return &row == &rowOf(row.channel); }));
static_assert(sizeof(Material) == kMaterialChannels * sizeof(double));

constexpr std::string_view name(MaterialChannel channel) { // "stiffness", "friction.static", ...
  return rowOf(channel).key;
}
constexpr std::string_view unit(MaterialChannel channel) { // "N/m", "" ...
  return rowOf(channel).unit;
}
// Returns the first channel of the channel's tool.
constexpr MaterialChannel firstOfTool(MaterialChannel channel) {
  for (const Channel& row : kChannels)
    if (row.tool == rowOf(channel).tool) return row.channel;
  return channel;
}
constexpr MaterialRange rangeOf(MaterialChannel channel) {
  return rowOf(channel).range;
}
constexpr double& valueOf(Material& material, MaterialChannel channel) {
  return material.*rowOf(channel).value;
}
constexpr double valueOf(const Material& material, MaterialChannel channel) {
  return material.*rowOf(channel).value;
}

} // namespace patina
