#include "visualization/values/view_options.h"

#include "core/error.h"
#include "core/named.h"

namespace patina {
namespace {

const std::vector<Named<Layer>>& layerNames() {
  static const auto all = [] {
    std::vector<Named<Layer>> names{
        {Layer::mesh, "mesh"},           {Layer::iso, "iso"},
        {Layer::slice, "slice"},         {Layer::band, "band"},
        {Layer::extent, "extent"},       {Layer::tip, "tip"},
        {Layer::nodes, "nodes"},         {Layer::stability, "stability"},
        {Layer::wireframe, "wireframe"}, {Layer::scale, "scale"},
        {Layer::color, "color"},         {Layer::relief, "relief"}};
    for (const Channel& row : kChannels)
      names.push_back({layerOf(quantityOf(row.channel)), row.key});
    return names;
  }();
  return all;
}

constexpr Named<ViewPreset> kViews[] = {{ViewPreset::plus_x, "+x"}, {ViewPreset::minus_x, "-x"},
                                        {ViewPreset::plus_y, "+y"}, {ViewPreset::minus_y, "-y"},
                                        {ViewPreset::plus_z, "+z"}, {ViewPreset::minus_z, "-z"},
                                        {ViewPreset::iso, "iso"}};

template <typename Table> auto parsed(const Table& table, std::string_view text, const char* what) {
  if (const auto found = parseIn(table, text)) return *found;
  throw Error("unknown " + std::string(what) + " '" + std::string(text) + "'; choose from " +
              allNames(table));
}

template <typename Table> auto valuesOf(const Table& table) {
  std::vector<decltype(table[0].value)> values;
  for (const auto& row : table) values.push_back(row.value);
  return values;
}

} // namespace

std::set<Layer> parseLayers(std::string_view text) {
  std::set<Layer> layers;
  while (true) {
    const auto comma = text.find(',');
    layers.insert(parsed(layerNames(), text.substr(0, comma), "layer"));
    if (comma == std::string_view::npos) return layers;
    text.remove_prefix(comma + 1);
  }
}

std::string_view name(Layer layer) {
  return nameIn(layerNames(), layer);
}

const std::vector<Layer>& allLayers() {
  static const auto layers = valuesOf(layerNames());
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
  return nameIn(kViews, view);
}

const std::vector<ViewPreset>& allViews() {
  static const auto views = valuesOf(kViews);
  return views;
}

} // namespace patina
