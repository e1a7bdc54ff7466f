#include "visualization/values/color_table.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "visualization/values/distance_map.h"
#include "visualization/values/paint_quantity.h"

namespace patina {
namespace {

constexpr int kTableEntries = 256;

// Even stations, 0xRRGGBB; the colours between them are interpolated.
constexpr std::uint32_t kViridis[] = {0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21908c,
                                      0x27ad81, 0x5dc863, 0xaadc32, 0xfde725};
constexpr std::uint32_t kMagma[] = {0x000004, 0x1d1147, 0x51127c, 0x822681, 0xb63679,
                                    0xe65164, 0xfb8861, 0xfec287, 0xfcfdbf};
constexpr std::uint32_t kCividis[] = {0x00204d, 0x012b65, 0x11366c, 0x26426e, 0x3c4d6e, 0x51586e,
                                      0x62646f, 0x727071, 0x7f7c75, 0x8c8877, 0x9a9478, 0xa9a177,
                                      0xbbaf71, 0xcebd68, 0xe2cb5c, 0xf3da4f, 0xfdea45};
constexpr std::uint32_t kTurbo[] = {0x30123b, 0x4440ab, 0x4569ee, 0x3295f7, 0x26bce1, 0x29dcbc,
                                    0x3ff393, 0x65fd6e, 0x95fb51, 0xc5ec3c, 0xecd12e, 0xffad24,
                                    0xff821d, 0xf05616, 0xcb2f0d, 0xa31302, 0x7a0403};
constexpr std::uint32_t kGreys[] = {0x000000, 0xffffff};

palette::Color between(std::span<const std::uint32_t> stations, double t) {
  const double at = t * static_cast<double>(stations.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), stations.size() - 2);
  const double part = at - static_cast<double>(low);
  palette::Color color{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto channel = [&](std::size_t i) { return (stations[i] >> (16 - 8 * c)) & 0xff; };
    color[c] = ((1 - part) * channel(low) + part * channel(low + 1)) / 255;
  }
  return color;
}

} // namespace

palette::Color mapColor(ColorMap map, double t) {
  t = std::clamp(t, 0.0, 1.0);
  switch (map) {
  case ColorMap::viridis:
    return between(kViridis, t);
  case ColorMap::cividis:
    return between(kCividis, t);
  case ColorMap::magma:
    return between(kMagma, t);
  case ColorMap::turbo:
    return between(kTurbo, t);
  case ColorMap::greys:
    return between(kGreys, t);
  case ColorMap::standard:
  case ColorMap::cool_warm:
    break;
  }
  static const auto both = distanceMap(1); // warm at the low end
  palette::Color color{};
  both->GetColor(1 - 2 * t, color.data());
  return color;
}

vtkSmartPointer<vtkLookupTable> colorTable(const ColorScale& scale, StandardMap standard,
                                           const ValueRange& range) {
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  const int entries = scale.bands > 0 ? scale.bands : kTableEntries - 1;
  table->SetNumberOfTableValues(entries);
  table->SetRange(range.low, range.high);
  if (scale.logarithmic && range.low > 0) table->SetScaleToLog10();
  const auto sequential = paintColors(PaintQuantity::first_channel, {0, 1});
  const double reach = std::max({std::abs(range.low), std::abs(range.high), 1e-300});
  for (int i = 0; i < entries; ++i) {
    // The outer bands have the colours of the ends.
    double t = scale.bands > 1 ? static_cast<double>(i) / (entries - 1) : (i + 0.5) / entries;
    if (scale.reversed) t = 1 - t;
    palette::Color color{};
    if (scale.map != ColorMap::standard)
      color = mapColor(scale.map, t);
    else if (standard == StandardMap::sequential)
      sequential->GetColor(t, color.data());
    else
      color = mapColor(ColorMap::cool_warm,
                       0.5 - 0.5 * (range.low + t * (range.high - range.low)) / reach);
    table->SetTableValue(i, color[0], color[1], color[2], 1);
  }
  table->SetNanColor(palette::kToolShaft[0], palette::kToolShaft[1], palette::kToolShaft[2], 1);
  return table;
}

std::string labelFormat(const ColorScale& scale, const char* automatic) {
  return scale.digits ? "%." + std::to_string(*scale.digits) + "g" : automatic;
}

} // namespace patina
