#include "visualization/values/scalar_bar.h"

#include <algorithm>

#include <vtkProperty2D.h>
#include <vtkTextProperty.h>

#include "visualization/values/palette.h"

namespace patina {

// With an empty line below, or the bar would touch it.
void setTitle(vtkScalarBarActor& bar, const std::string& title) {
  bar.SetTitle((title + "\n").c_str());
}

vtkSmartPointer<vtkScalarBarActor> scalarBar(const std::string& title) {
  auto bar = vtkSmartPointer<vtkScalarBarActor>::New();
  setTitle(*bar, title);
  bar->UnconstrainedFontSizeOn();
  for (vtkTextProperty* text : {bar->GetTitleTextProperty(), bar->GetLabelTextProperty()}) {
    text->ItalicOff();
    text->BoldOff();
    text->ShadowOff();
  }
  bar->GetTitleTextProperty()->BoldOn();
  // Of what is no value: a tag beside its swatch.
  bar->GetAnnotationTextProperty()->ShallowCopy(bar->GetLabelTextProperty());
  bar->SetBarRatio(0.22);
  // Its own plate: what lies behind never mixes with the colours that are read.
  bar->DrawBackgroundOn();
  bar->DrawFrameOn(); // seen where the ground is as light as the plate
  bar->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  return bar;
}

double scalarBarShare(int wide, const Lettering& letters) {
  return wide > 0 ? std::clamp(8.8 * letters.pixels / wide, 0.12, 0.3) : 0.12;
}

void placeScalarBar(vtkScalarBarActor& bar, int place, const Lettering& letters,
                    const std::array<int, 2>& size) {
  const auto [wide, high] = size;
  const double share = scalarBarShare(wide, letters);
  const double line = high > 0 ? 1.0 * letters.pixels / high : 0.02;
  const double height = std::clamp(14 * line, 0.5, 0.8);
  bar.SetWidth(share - 0.01);
  bar.SetHeight(height);
  bar.SetPosition(1 - share * (place + 1), 0.52 - height / 2);
  // As many numbers as stand apart.
  bar.SetNumberOfLabels(std::clamp(static_cast<int>((height / line - 5) / 1.8), 2, 5));
  // Half of the first and of the last number is beyond the colours: it stays on the plate.
  bar.SetTextPad(letters.pixels);
  for (vtkTextProperty* text : {bar.GetTitleTextProperty(), bar.GetLabelTextProperty()})
    write(*text, letters, letters.ground.text, false);
  write(*bar.GetAnnotationTextProperty(), letters, letters.ground.text, true);
  bar.GetBackgroundProperty()->SetColor(palette::forVtk(letters.ground.plate));
  bar.GetFrameProperty()->SetColor(palette::forVtk(palette::kQuiet));
}

} // namespace patina
