// One stroke of the brush, as it is recorded, replayed and undone (K15 to K19).
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
  MaterialChannel channel{}; // of material

  static const Tool color, relief;
  static const Tool erase; // of everything that was painted, or of `erases` alone
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
  power, // 1 - (d/r)^f, our reading of the paper's lost equation (1) (K17)
  cone,  // (1 - d/r)^f
  smooth // (1 - (d/r)^2)^f
};
enum class StrokeMode : std::uint8_t {
  max,      // a place takes the greatest weight of the stroke once: the same at 30 and at 60 Hz
  build_up, // every dab lays on again
  add,      // value is added, greatest weight once; not for colour
  smooth    // every dab moves values towards their neighbours'
};
enum class Seed : std::uint8_t {
  nearest, // the surface's point nearest to the sample
  segment  // where the way from the tip to the sample goes through the surface (K15)
};
enum class Symmetry : std::uint8_t { none, x, y, z }; // across the middle of the object's box

struct BrushLayer {
  Tool tool = Tool::color;
  std::array<double, 3> color{1, 0, 0}; // sRGB in [0, 1], of Tool::color
  double value = 0;                     // SI, of the other tools: relief [m], stiffness [N/m] ...
  bool operator==(const BrushLayer&) const = default;
};

struct Brush : BrushLayer {
  std::vector<BrushLayer> also; // laid on by the same stroke, each with a tool of its own; no erase
  double radius = 0.005;        // r [m]
  double radius_per_force = 0;  // k_r [m/N]: r + k_r |F|, K19
  double least_radius = 0, most_radius = 1; // [m], clamp of that
  double falloff = 1;                       // f > 0
  BrushShape shape = BrushShape::power;
  StrokeMode mode = StrokeMode::max;
  bool front_only = false; // only faces that look the way the seed face does
  Seed seed = Seed::nearest;
  Symmetry symmetry = Symmetry::none;
  std::string erases; // "" = everything, or a tool's name
  bool operator==(const Brush&) const = default;
};

struct StrokeSample {
  double t = 0;                 // [s]
  Vec3 position = Vec3::Zero(); // [m], world: the point of the surface under the tip, or near it
  double force = 0;             // |F| [N]
  std::optional<Vec3> tip{};    // [m], world: for Seed::segment, which without it is nearest
  bool operator==(const StrokeSample&) const = default;
};

struct Stroke {
  Brush brush;
  std::vector<StrokeSample> samples; // times ascend
  bool operator==(const Stroke&) const = default;
};

// Whether a sample of the way, which is not empty, lies farther than `off` [m] from the straight
// line from its first one to the next.
bool strays(std::span<const StrokeSample> way, const StrokeSample& next, double off);

Seed parseSeed(const std::string& text); // throws Error
// As in files: "color", "friction.static", ...
constexpr std::string_view name(const Tool& tool) {
  if (tool.kind == Tool::Kind::material) return name(tool.channel);
  return tool == Tool::color ? "color" : tool == Tool::relief ? "relief" : "erase";
}
// The channel that a tool paints; nullopt for colour, relief and erase.
constexpr std::optional<MaterialChannel> channelOf(const Tool& tool) {
  return tool.kind == Tool::Kind::material ? std::optional(tool.channel) : std::nullopt;
}

std::vector<BrushLayer> layersOf(const Brush& brush);     // one or more, its own first
const BrushLayer* layerOf(const Brush& brush, Tool tool); // null: it lays on none of that

// Throws Error in one line that names what is out of range: radius and falloff > 0 (a radius of 0
// paints nothing and is allowed), finite values, colours in [0, 1], the channel's range, each tool
// once.
void validate(const Brush& brush);
void validate(const Stroke& stroke);
// Throws Error for a stroke that has none. It paints nothing, and journals of before may hold it;
// what is to be painted may not.
void requireSamples(const Stroke& stroke);

Json toJson(const Stroke& stroke);
// Throws Error naming the key. Unknown keys are an error; what may be left out has Brush's value.
Stroke strokeFrom(const Json& json);
// {"version": 1, "strokes": [...]}; throws FileError(name, line, "stroke 3: ...") with the
// line where the stroke begins, also for a stroke without samples.
std::vector<Stroke> parseStrokes(std::string_view text, const std::string& name);
Json toJson(const std::vector<Stroke>& strokes);

} // namespace patina
