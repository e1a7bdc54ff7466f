#include "visualization/view/view_options.h"

#include <array>
#include <utility>

#include "core/error.h"

namespace patina {
namespace {

constexpr std::array<std::pair<Layer, std::string_view>, 16> kLayers{{
    {Layer::mesh, "mesh"},
    {Layer::iso, "iso"},
    {Layer::slice, "slice"},
    {Layer::band, "band"},
    {Layer::extent, "extent"},
    {Layer::tip, "tip"},
    {Layer::nodes, "nodes"},
    {Layer::stability, "stability"},
    {Layer::wireframe, "wireframe"},
    {Layer::color, "color"},
    {Layer::relief, "relief"},
    {Layer::stiffness, "stiffness"},
    {Layer::static_friction, "friction.static"},
    {Layer::dynamic_friction, "friction.dynamic"},
    {Layer::damping, "damping"},
    {Layer::roughness, "roughness"},
}};

constexpr std::array<std::pair<ViewPreset, std::string_view>, 7> kViews{{
    {ViewPreset::plus_x, "+x"},
    {ViewPreset::minus_x, "-x"},
    {ViewPreset::plus_y, "+y"},
    {ViewPreset::minus_y, "-y"},
    {ViewPreset::plus_z, "+z"},
    {ViewPreset::minus_z, "-z"},
    {ViewPreset::iso, "iso"},
}};

template <typename Table>
auto parsed(const Table& table, std::string_view text, const char* what) ->
    typename Table::value_type::first_type {
  std::string choices;
  for (const auto& [value, word] : table) {
    if (word == text) return value;
    choices += (choices.empty() ? "" : ", ") + std::string(word);
  }
  throw Error("unknown " + std::string(what) + " '" + std::string(text) + "'; choose from " +
              choices);
}

template <typename Table, typename Value> std::string_view wordOf(const Table& table, Value value) {
  for (const auto& [candidate, word] : table)
    if (candidate == value) return word;
  return {};
}

template <typename Table> auto valuesOf(const Table& table) {
  std::vector<typename Table::value_type::first_type> values;
  for (const auto& entry : table) values.push_back(entry.first);
  return values;
}

} // namespace

std::set<Layer> parseLayers(std::string_view text) {
  std::set<Layer> layers;
  while (true) {
    const auto comma = text.find(',');
    layers.insert(parsed(kLayers, text.substr(0, comma), "layer"));
    if (comma == std::string_view::npos) return layers;
    text.remove_prefix(comma + 1);
  }
}

std::string_view name(Layer layer) {
  return wordOf(kLayers, layer);
}

const std::vector<Layer>& allLayers() {
  static const auto layers = valuesOf(kLayers);
  return layers;
}

std::optional<PaintQuantity> paintOf(Layer layer) {
  if (layer < Layer::color) return std::nullopt;
  return static_cast<PaintQuantity>(static_cast<int>(layer) - static_cast<int>(Layer::color));
}

Layer layerOf(PaintQuantity quantity) {
  return static_cast<Layer>(static_cast<int>(quantity) + static_cast<int>(Layer::color));
}

ViewPreset parseView(std::string_view text) {
  return parsed(kViews, text, "view");
}

std::string_view name(ViewPreset view) {
  return wordOf(kViews, view);
}

const std::vector<ViewPreset>& allViews() {
  static const auto views = valuesOf(kViews);
  return views;
}

} // namespace patina
