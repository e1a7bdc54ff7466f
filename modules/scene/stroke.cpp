#include "scene/stroke.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/named.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr double kMaxRadius = 1;    // [m], largest brush
constexpr double kMaxFalloff = 1e6; // acts like a hard brush
constexpr double kMaxHeight = 0.1;  // [m], of relief

template <typename Table>
auto chosen(const char* key, const std::string& text, const Table& table) {
  if (const auto found = parseIn(table, text)) return *found;
  throw Error(std::string(key) + " '" + text + "': it must be one of " + allNames(table));
}

constexpr auto kToolNames = [] {
  std::array<Named<Tool>, kTools.size()> all{};
  std::transform(kTools.begin(), kTools.end(), all.begin(), [](const Tool& tool) {
    return Named<Tool>{tool, name(tool)};
  });
  return all;
}();
constexpr Named<BrushShape> kShapeNames[] = {
    {BrushShape::power, "power"}, {BrushShape::cone, "cone"}, {BrushShape::smooth, "smooth"}};
constexpr Named<StrokeMode> kModeNames[] = {{StrokeMode::max, "max"},
                                            {StrokeMode::build_up, "build-up"},
                                            {StrokeMode::add, "add"},
                                            {StrokeMode::smooth, "smooth"}};
constexpr Named<DabAnchor> kDabAnchorNames[] = {{DabAnchor::nearest, "nearest"},
                                                {DabAnchor::segment, "segment"}};
constexpr Named<Symmetry> kSymmetryNames[] = {
    {Symmetry::none, "none"}, {Symmetry::x, "x"}, {Symmetry::y, "y"}, {Symmetry::z, "z"}};

void require(bool holds, const char* key, double value, const std::string& what) {
  if (!holds) throw Error(std::string(key) + " = " + formatNumber(value) + ": it must be " + what);
}

void requireBetween(const char* key, double value, double low, double high) {
  require(value >= low && value <= high, key, value,
          "between " + formatNumber(low) + " and " + formatNumber(high));
}

// Excludes a stiffness of 0, which would be no contact.
MaterialRange valueRange(Tool tool, StrokeMode mode) {
  if (tool == Tool::relief) return {-kMaxHeight, kMaxHeight};
  MaterialRange range = rangeOf(*channelOf(tool));
  if (mode == StrokeMode::add) range.min = -range.max;
  return range;
}

void validateLayer(const BrushLayer& layer, StrokeMode mode) {
  if (layer.tool == Tool::color) {
    for (const double part : layer.color) requireBetween("value", part, 0, 1);
    if (mode == StrokeMode::add) throw Error("mode add: colours cannot be added");
  } else if (layer.tool != Tool::erase) {
    const MaterialRange range = valueRange(layer.tool, mode);
    requireBetween("value", layer.value, range.min, range.max);
  }
}

void validateLayers(const Brush& brush) {
  const std::vector<BrushLayer> layers = layersOf(brush);
  for (auto layer = layers.begin(); layer != layers.end(); ++layer) {
    validateLayer(*layer, brush.mode);
    if (layers.size() > 1 && layer->tool == Tool::erase)
      throw Error("layers: erase must be the only one");
    if (std::any_of(layers.begin(), layer, [&](const auto& l) { return l.tool == layer->tool; }))
      throw Error("layers: " + std::string(name(layer->tool)) + " is used twice");
  }
}

Vec3 vectorFrom(const Json& json) {
  const Json::Array& list = json.asArray();
  if (list.size() != 3) throw Error("must be 3 numbers");
  return {list[0].asNumber(), list[1].asNumber(), list[2].asNumber()};
}

Json jsonOf(double x, double y, double z) {
  Json list = Json::array();
  list.push(x);
  list.push(y);
  list.push(z);
  return list;
}

StrokeSample sampleFrom(const Json& json) {
  StrokeSample sample;
  for (const auto& [key, value] : json.asObject()) {
    if (key == "t")
      sample.t = value.asNumber();
    else if (key == "position")
      sample.position = vectorFrom(value);
    else if (key == "force")
      sample.force = value.asNumber();
    else if (key == "tip")
      sample.tip = vectorFrom(value);
    else
      throw Error("unknown key '" + key + "'");
  }
  (void)json.at("position");
  return sample;
}

std::vector<StrokeSample> samplesFrom(const Json& json) {
  std::vector<StrokeSample> samples;
  for (const Json& item : json.asArray()) {
    try {
      samples.push_back(sampleFrom(item));
    } catch (const Error& error) {
      throw Error("sample " + std::to_string(samples.size() + 1) + ": " + error.what());
    }
  }
  return samples;
}

void setValue(BrushLayer& layer, const Json& value) {
  if (value.isArray()) {
    const Vec3 color = vectorFrom(value);
    layer.color = {color.x(), color.y(), color.z()};
    if (layer.tool != Tool::color)
      throw Error("must be a number for tool " + std::string(name(layer.tool)));
  } else {
    layer.value = value.asNumber();
    if (layer.tool == Tool::color) throw Error("must be [r, g, b] for tool color");
  }
}

// Reads the keys of a layer and ignores others.
BrushLayer layerFrom(const Json& json, bool needs_value) {
  BrushLayer layer;
  layer.tool = chosen("tool", json.at("tool").asString(), kToolNames);
  if (const Json* value = json.find("value")) {
    try {
      setValue(layer, *value);
    } catch (const Error& error) {
      throw Error(std::string("'value' ") + error.what());
    }
  } else if (needs_value && layer.tool != Tool::erase) {
    (void)json.at("value");
  }
  return layer;
}

Json toJson(const BrushLayer& layer, Json json) {
  json.set("tool", name(layer.tool));
  if (layer.tool == Tool::color)
    json.set("value", jsonOf(layer.color[0], layer.color[1], layer.color[2]));
  else if (layer.tool != Tool::erase)
    json.set("value", layer.value);
  return json;
}

void setLayers(Brush& brush, const Json& json) {
  const bool needs_value = brush.mode != StrokeMode::smooth;
  const Json* several = json.find("layers");
  if (!several) {
    static_cast<BrushLayer&>(brush) = layerFrom(json, needs_value);
    return;
  }
  if (json.find("tool") || json.find("value"))
    throw Error("'layers' cannot be combined with 'tool' and 'value'");
  std::vector<BrushLayer> layers;
  for (const Json& item : several->asArray()) {
    try {
      for (const auto& [key, value] : item.asObject())
        if (key != "tool" && key != "value") throw Error("unknown key '" + key + "'");
      layers.push_back(layerFrom(item, needs_value));
    } catch (const Error& error) {
      throw Error("layer " + std::to_string(layers.size() + 1) + ": " + error.what());
    }
  }
  if (layers.empty()) throw Error("'layers' must hold one layer or more");
  static_cast<BrushLayer&>(brush) = layers.front();
  brush.extra_layers.assign(layers.begin() + 1, layers.end());
}

void setKey(Stroke& stroke, const std::string& key, const Json& value) {
  Brush& brush = stroke.brush;
  if (key == "radius")
    brush.radius = value.asNumber();
  else if (key == "radius_per_force")
    brush.radius_per_force = value.asNumber();
  else if (key == "least_radius")
    brush.min_radius = value.asNumber();
  else if (key == "most_radius")
    brush.max_radius = value.asNumber();
  else if (key == "falloff")
    brush.falloff = value.asNumber();
  else if (key == "shape")
    brush.shape = chosen("shape", value.asString(), kShapeNames);
  else if (key == "mode")
    brush.mode = chosen("mode", value.asString(), kModeNames);
  else if (key == "front_only")
    brush.front_only = value.asBool();
  else if (key == "seed")
    brush.anchor = parseDabAnchor(value.asString());
  else if (key == "symmetry")
    brush.symmetry = chosen("symmetry", value.asString(), kSymmetryNames);
  else if (key == "erases")
    brush.erases = value.asString();
  else if (key == "samples")
    stroke.samples = samplesFrom(value);
  else
    throw Error("unknown key");
}

Stroke strokeOfKeys(const Json& json) {
  Stroke stroke;
  for (const auto& [key, value] : json.asObject()) {
    if (key == "tool" || key == "value" || key == "layers") continue; // read below
    try {
      setKey(stroke, key, value);
    } catch (const Error& error) {
      const std::string what = error.what();
      throw what.starts_with(key) ? Error(what) : Error("'" + key + "' " + what);
    }
  }
  (void)json.at("samples");
  setLayers(stroke.brush, json); // after the mode, which decides whether values are required
  return stroke;
}

} // namespace

bool deviatesFromChord(std::span<const StrokeSample> way, const StrokeSample& next, double off) {
  const Vec3& start = way.front().position;
  const Vec3 along = next.position - start;
  const double length = along.squaredNorm();
  return std::any_of(way.begin(), way.end(), [&](const StrokeSample& sample) {
    const Vec3 from = sample.position - start;
    const double part = length > 0 ? std::clamp(from.dot(along) / length, 0.0, 1.0) : 0;
    return !((from - part * along).norm() <= off);
  });
}

DabAnchor parseDabAnchor(const std::string& text) {
  return chosen("seed", text, kDabAnchorNames);
}

std::vector<BrushLayer> layersOf(const Brush& brush) {
  std::vector<BrushLayer> layers{brush};
  layers.insert(layers.end(), brush.extra_layers.begin(), brush.extra_layers.end());
  return layers;
}

const BrushLayer* layerOf(const Brush& brush, Tool tool) {
  if (brush.tool == tool) return &brush;
  const auto layer = std::find_if(brush.extra_layers.begin(), brush.extra_layers.end(),
                                  [&](const BrushLayer& l) { return l.tool == tool; });
  return layer == brush.extra_layers.end() ? nullptr : &*layer;
}

void validate(const Brush& brush) {
  requireBetween("radius", brush.radius, 0, kMaxRadius);
  requireBetween("radius_per_force", brush.radius_per_force, -kMaxRadius, kMaxRadius);
  requireBetween("least_radius", brush.min_radius, 0, kMaxRadius);
  requireBetween("most_radius", brush.max_radius, brush.min_radius, kMaxRadius);
  require(brush.falloff > 0 && brush.falloff <= kMaxFalloff, "falloff", brush.falloff,
          "above 0 and at most " + formatNumber(kMaxFalloff));
  validateLayers(brush);
  if (!brush.erases.empty()) {
    if (brush.tool != Tool::erase) throw Error("'erases' belongs to tool erase");
    if (chosen("erases", brush.erases, kToolNames) == Tool::erase)
      throw Error("erases 'erase': it must name another tool");
  }
}

void validate(const Stroke& stroke) {
  validate(stroke.brush);
  double last = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < stroke.samples.size(); ++i) {
    const StrokeSample& sample = stroke.samples[i];
    const std::string where = "sample " + std::to_string(i + 1) + ": ";
    if (!sample.position.allFinite() || !std::isfinite(sample.t))
      throw Error(where + "time and position must be finite");
    if (sample.tip && !sample.tip->allFinite()) throw Error(where + "its tip must be finite");
    if (!(sample.force >= 0) || !std::isfinite(sample.force))
      throw Error(where + "force = " + formatNumber(sample.force) + ": it must be 0 or more");
    if (sample.t < last) throw Error(where + "its time is before the last one's");
    last = sample.t;
  }
}

void requireSamples(const Stroke& stroke) {
  if (stroke.samples.empty()) throw Error("'samples' is empty: a stroke has one or more");
}

Json toJson(const Stroke& stroke) {
  const Brush& brush = stroke.brush;
  const Brush defaults;
  Json json = Json::object();
  if (brush.extra_layers.empty()) {
    json = toJson(static_cast<const BrushLayer&>(brush), std::move(json));
  } else {
    Json layers = Json::array();
    for (const BrushLayer& layer : layersOf(brush)) layers.push(toJson(layer, Json::object()));
    json.set("layers", std::move(layers));
  }
  json.set("radius", brush.radius).set("falloff", brush.falloff);
  json.set("shape", nameIn(kShapeNames, brush.shape)).set("mode", nameIn(kModeNames, brush.mode));
  json.set("front_only", brush.front_only);
  if (brush.radius_per_force != 0) json.set("radius_per_force", brush.radius_per_force);
  if (brush.min_radius != defaults.min_radius) json.set("least_radius", brush.min_radius);
  if (brush.max_radius != defaults.max_radius) json.set("most_radius", brush.max_radius);
  if (brush.anchor != DabAnchor::nearest) json.set("seed", nameIn(kDabAnchorNames, brush.anchor));
  if (brush.symmetry != Symmetry::none)
    json.set("symmetry", nameIn(kSymmetryNames, brush.symmetry));
  if (!brush.erases.empty()) json.set("erases", brush.erases);
  Json samples = Json::array();
  for (const StrokeSample& sample : stroke.samples) {
    const Vec3& p = sample.position;
    Json item = Json::object();
    item.set("t", sample.t).set("position", jsonOf(p.x(), p.y(), p.z()));
    item.set("force", sample.force);
    if (sample.tip) item.set("tip", jsonOf(sample.tip->x(), sample.tip->y(), sample.tip->z()));
    samples.push(std::move(item));
  }
  json.set("samples", std::move(samples));
  return json;
}

Stroke strokeFrom(const Json& json) {
  Stroke stroke = strokeOfKeys(json);
  validate(stroke);
  return stroke;
}

} // namespace patina
