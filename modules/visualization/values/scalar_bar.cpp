#include "visualization/values/scalar_bar.h"

#include <algorithm>

#include <vtkProperty2D.h>
#include <vtkTextProperty.h>

#include "visualization/values/palette.h"

namespace patina {

// An empty line below keeps the title off the bar.
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
  // Tags of special values beside their swatches.
  bar->GetAnnotationTextProperty()->ShallowCopy(bar->GetLabelTextProperty());
  bar->SetBarRatio(0.22);
  // Opaque, so that the scene does not mix with the colours.
  bar->DrawBackgroundOn();
  bar->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  return bar;
}

double scalarBarShare(int wide, const TextStyle& letters) {
  return wide > 0 ? std::clamp(8.8 * letters.pixels / wide, 0.12, 0.3) : 0.12;
}

void placeScalarBar(vtkScalarBarActor& bar, int place, const TextStyle& letters,
                    const std::array<int, 2>& size) {
  const auto [wide, high] = size;
  const double share = scalarBarShare(wide, letters);
  const double line = high > 0 ? 1.0 * letters.pixels / high : 0.02;
  const double height = std::clamp(14 * line, 0.5, 0.8);
  bar.SetWidth(share - 0.01);
  bar.SetHeight(height);
  bar.SetPosition(1 - share * (place + 1), 0.52 - height / 2);
  // As many numbers as fit.
  bar.SetNumberOfLabels(std::clamp(static_cast<int>((height / line - 5) / 1.8), 2, 5));
  bar.SetTextPad(0); // with VTK's padding the numbers would not stand at their colours
  if (*bar.GetLabelFormat() != ' ')
    bar.SetLabelFormat((std::string("  ") + bar.GetLabelFormat() + " ").c_str());
  write(*bar.GetTitleTextProperty(), letters, letters.ground.text, true); // above the background
  write(*bar.GetLabelTextProperty(), letters, letters.ground.text, false);
  write(*bar.GetAnnotationTextProperty(), letters, letters.ground.text, true);
  bar.GetBackgroundProperty()->SetColor(palette::forVtk(letters.ground.text_background));
  bar.SetDrawBackground(letters.ground.plates);
}

} // namespace patina
