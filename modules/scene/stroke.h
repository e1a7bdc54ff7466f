// One brush stroke as recorded, replayed and undone (K15 to K19).
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.h"
#include "core/types.h"
#include "scene/paint/material_map.h"

namespace patina {

struct Tool {
  enum class Kind : std::uint8_t { color, relief, material, erase };
  Kind kind = Kind::color;
  MaterialChannel channel{}; // only for kind material

  static const Tool color, relief;
  static const Tool erase; // erases all paint, or that of Brush::erases
  static constexpr Tool material(MaterialChannel channel) { return {Kind::material, channel}; }
  auto operator<=>(const Tool&) const = default;
};
inline constexpr Tool Tool::color{Kind::color}, Tool::relief{Kind::relief},
    Tool::erase{Kind::erase};
// Colour, relief, each channel, erase.
inline constexpr auto kTools = [] {
  std::array<Tool, kMaterialChannels + 3> all{Tool::color, Tool::relief};
  std::transform(kChannels.begin(), kChannels.end(), all.begin() + 2,
                 [](const Channel& row) { return Tool::material(row.channel); });
  all.back() = Tool::erase;
  return all;
}();
enum class BrushShape : std::uint8_t {
  power, // 1 - (d/r)^f, our reading of the paper's missing equation (1) (K17)
  cone,  // (1 - d/r)^f
  smooth // (1 - (d/r)^2)^f
};
enum class StrokeMode : std::uint8_t {
  max,      // a point takes the largest weight of the stroke once: the same at 30 and at 60 Hz
  build_up, // every dab composites again
  add,      // adds the value, with the largest weight once; not for colour
  smooth    // every dab smooths values with their neighbours
};
enum class DabAnchor : std::uint8_t {
  nearest, // surface point nearest to the sample
  segment  // intersection of the segment from tip to sample with the surface (K15)
};
enum class Symmetry : std::uint8_t { none, x, y, z }; // about the middle of the object's box

struct BrushLayer {
  Tool tool = Tool::color;
  std::array<double, 3> color{1, 0, 0}; // sRGB in [0, 1], for Tool::color
  double value = 0;                     // SI, for other tools: relief [m], stiffness [N/m] ...
  bool operator==(const BrushLayer&) const = default;
};

struct Brush : BrushLayer {
  std::vector<BrushLayer>
      extra_layers;            // extra layers of the same stroke, each with another tool; no erase
  double radius = 0.005;       // r [m]
  double radius_per_force = 0; // k_r [m/N]: r + k_r |F|, K19
  double min_radius = 0, max_radius = 1; // [m], limits of that
  double falloff = 1;                    // f > 0
  BrushShape shape = BrushShape::power;
  StrokeMode mode = StrokeMode::max;
  bool front_only = false; // only faces oriented like the seed face
  DabAnchor anchor = DabAnchor::nearest;
  Symmetry symmetry = Symmetry::none;
  std::string erases; // "" = all paint, or a tool's name
  bool operator==(const Brush&) const = default;
};

struct StrokeSample {
  double t = 0;                 // [s]
  Vec3 position = Vec3::Zero(); // [m], world: surface point under the tip, or near it
  double force = 0;             // |F| [N]
  std::optional<Vec3> tip{};    // [m], world: for DabAnchor::segment
  bool operator==(const StrokeSample&) const = default;
};

struct Stroke {
  Brush brush;
  std::vector<StrokeSample> samples; // ascending in time
  bool operator==(const Stroke&) const = default;
};

// Returns true if a sample of the non-empty `way` lies farther than `off` [m] from the chord from
// its first sample to the next (Douglas & Peucker 1973).
bool deviatesFromChord(std::span<const StrokeSample> way, const StrokeSample& next, double off);

DabAnchor parseDabAnchor(const std::string& text); // throws Error
// Name in files: "color", "friction.static", ...
constexpr std::string_view name(const Tool& tool) {
  if (tool.kind == Tool::Kind::material) return name(tool.channel);
  return tool == Tool::color ? "color" : tool == Tool::relief ? "relief" : "erase";
}
// Returns the channel that a tool paints; nullopt for colour, relief and erase.
constexpr std::optional<MaterialChannel> channelOf(const Tool& tool) {
  return tool.kind == Tool::Kind::material ? std::optional(tool.channel) : std::nullopt;
}

std::vector<BrushLayer> layersOf(const Brush& brush);     // one or more, the brush's own first
const BrushLayer* layerOf(const Brush& brush, Tool tool); // null if no layer has that tool

// Throws Error in one line that names the invalid value: radius (0 paints nothing and is allowed)
// and falloff must be > 0, values finite, colours in [0, 1], others in the channel's range, tools
// unique.
void validate(const Brush& brush);
void validate(const Stroke& stroke);
// Throws Error for a stroke without samples. Old journals may contain such strokes, which paint
// nothing; new strokes must have samples.
void requireSamples(const Stroke& stroke);

Json toJson(const Stroke& stroke);
// Throws Error naming the key, also for unknown keys. Optional keys default to Brush's values.
Stroke strokeFrom(const Json& json);
// Parses {"version": 1, "strokes": [...]}. Throws FileError(name, line, "stroke 3: ...") with the
// first line of the stroke, also for one without samples.
std::vector<Stroke> parseStrokes(std::string_view text, const std::string& name);
Json toJson(const std::vector<Stroke>& strokes);

} // namespace patina
