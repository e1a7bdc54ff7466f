#include "visualization/values/paint_quantity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <vtkMath.h>

#include "core/types.h"
#include "scene/paint/grey_relief.h"
#include "visualization/values/distance_map.h"
#include "visualization/values/palette.h"

namespace patina {
namespace {

constexpr int kEntries = 255;

// Colours equidistant in CIELAB along the line through the palette's stations.
std::vector<Vec3> sequentialColors() {
  std::vector<Vec3> lab;
  for (const palette::Color& color : palette::kMuch) {
    Vec3 station;
    vtkMath::RGBToLab(color.data(), station.data());
    lab.push_back(station);
  }
  double length = 0;
  for (std::size_t s = 1; s < lab.size(); ++s) length += (lab[s] - lab[s - 1]).norm();
  std::vector<Vec3> colors;
  std::size_t s = 1;
  double before = 0;
  for (int i = 0; i < kEntries; ++i) {
    const double at = length * i / (kEntries - 1);
    double step = (lab[s] - lab[s - 1]).norm();
    while (s + 1 < lab.size() && before + step < at) {
      before += step;
      ++s;
      step = (lab[s] - lab[s - 1]).norm();
    }
    const Vec3 here = lab[s - 1] + std::min(1.0, (at - before) / step) * (lab[s] - lab[s - 1]);
    Vec3 rgb;
    vtkMath::LabToRGB(here.data(), rgb.data());
    colors.push_back(rgb.cwiseMax(0).cwiseMin(1));
  }
  return colors;
}

} // namespace

bool hasPaint(const SceneObject& object, PaintQuantity quantity) {
  const ObjectPaint* paint = object.paint.get();
  if (paint == nullptr) return false;
  if (const auto channel = channelOf(quantity))
    return paint->material != nullptr && paint->material->has(*channel);
  if (!paint->layout.uvs) return false;
  return paint->relief != nullptr || (quantity == PaintQuantity::color && paint->color != nullptr);
}

bool hasPaint(const Scene& scene, PaintQuantity quantity) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& object) {
    if (quantity == PaintQuantity::relief)
      return object.paint && hasRelief(*object.paint, scene.relief.source);
    return hasPaint(object, quantity);
  });
}

std::string arrayName(PaintQuantity quantity) {
  if (quantity == PaintQuantity::color) return "color";
  if (quantity == PaintQuantity::relief) return "relief [m]";
  const MaterialChannel channel = *channelOf(quantity);
  const std::string_view si = unit(channel);
  return std::string(name(channel)) + (si.empty() ? "" : " [" + std::string(si) + "]");
}

ValueRange rounded(const ValueRange& range) {
  const double size = std::max(std::abs(range.low), std::abs(range.high));
  const double span = std::max({range.high - range.low, 0.2 * size, 1e-9});
  constexpr std::array<double, 10> kSteps{1, 1.25, 1.5, 2, 2.5, 3, 4, 5, 6, 8};
  constexpr double kSlack = 1e-6; // rounding error of a round number
  for (double power = std::pow(10, std::floor(std::log10(span / 4)));; power *= 10)
    for (const double step : kSteps) {
      const double quarter = step * power;
      const double low = quarter * std::floor(range.low / quarter + kSlack);
      const double high = low + 4 * quarter;
      if (range.high <= high + kSlack * quarter) return {low, high};
    }
}

vtkSmartPointer<vtkLookupTable> paintColors(PaintQuantity quantity, const ValueRange& range) {
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  table->SetNumberOfTableValues(kEntries);
  if (quantity == PaintQuantity::relief) {
    const auto both = divergingColors();
    const double reach = std::max({std::abs(range.low), std::abs(range.high), 1e-300});
    both->SetRange(-reach, reach);
    for (int i = 0; i < kEntries; ++i) {
      double color[3];
      both->GetColor(range.low + (range.high - range.low) * (i + 0.5) / kEntries, color);
      table->SetTableValue(i, color[0], color[1], color[2], 1);
    }
  } else {
    static const std::vector<Vec3> colors = sequentialColors();
    for (int i = 0; i < kEntries; ++i) {
      const Vec3& color = colors[static_cast<std::size_t>(i)];
      table->SetTableValue(i, color[0], color[1], color[2], 1);
    }
  }
  table->SetRange(range.low, range.high);
  table->SetNanColor(palette::kToolShaft[0], palette::kToolShaft[1], palette::kToolShaft[2], 1);
  return table;
}

ReadingUnit readingUnit(PaintQuantity quantity, const ValueRange& range) {
  if (quantity == PaintQuantity::color) return {"color", 1};
  const auto channel = channelOf(quantity);
  const auto titled = [](const std::string& words, std::string_view in) {
    return in.empty() ? words : words + " [" + std::string(in) + "]";
  };
  if (channel && unit(*channel) != "m")
    return {titled(std::string(rowOf(*channel).caption), unit(*channel)), 1};
  const bool fine = std::max(std::abs(range.low), std::abs(range.high)) < 0.95e-4;
  const std::string what(channel ? rowOf(*channel).caption : "relief");
  return {titled(what, fine ? "\xC2\xB5m" : "mm"), fine ? 1e6 : 1e3};
}

} // namespace patina
