#include "visualization/values/distance_map.h"

#include <vtkColorTransferFunction.h>

#include "visualization/values/palette.h"

namespace patina {

vtkSmartPointer<vtkLookupTable> divergingColors() {
  const vtkNew<vtkColorTransferFunction> ramp;
  ramp->SetColorSpaceToDiverging();
  ramp->AddRGBPoint(-1, palette::kInside[0], palette::kInside[1], palette::kInside[2]);
  ramp->AddRGBPoint(1, palette::kOutside[0], palette::kOutside[1], palette::kOutside[2]);
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  constexpr int kEntries = 255;
  table->SetNumberOfTableValues(kEntries);
  for (int i = 0; i < kEntries; ++i) {
    double color[3];
    ramp->GetColor(2.0 * i / (kEntries - 1) - 1, color);
    table->SetTableValue(i, color[0], color[1], color[2], 1);
  }
  return table;
}

vtkSmartPointer<vtkLookupTable> distanceMap(double limit_mm) {
  const auto table = divergingColors();
  table->SetRange(-limit_mm, limit_mm);
  return table;
}

} // namespace patina
