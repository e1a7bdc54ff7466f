#include "visualization/values/scalar_bar.h"

#include <vtkTextProperty.h>

#include "visualization/values/palette.h"

namespace patina {

vtkSmartPointer<vtkScalarBarActor> scalarBar(const std::string& title) {
  auto bar = vtkSmartPointer<vtkScalarBarActor>::New();
  bar->SetTitle((title + "\n").c_str());
  bar->SetNumberOfLabels(5);
  bar->UnconstrainedFontSizeOn();
  for (vtkTextProperty* text : {bar->GetTitleTextProperty(), bar->GetLabelTextProperty()}) {
    text->SetColor(palette::forVtk(palette::kText));
    text->SetFontFamilyToArial();
    text->ItalicOff();
    text->BoldOff();
    text->ShadowOff();
  }
  bar->GetTitleTextProperty()->BoldOn();
  bar->SetBarRatio(0.22);
  bar->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  bar->SetWidth(0.10);
  bar->SetHeight(0.46);
  placeScalarBar(*bar, 0);
  return bar;
}

void placeScalarBar(vtkScalarBarActor& bar, int place) {
  bar.SetPosition(0.885 - 0.12 * place, 0.28);
}

void setTextSize(vtkScalarBarActor& bar, int pixels) {
  for (vtkTextProperty* text : {bar.GetTitleTextProperty(), bar.GetLabelTextProperty()})
    text->SetFontSize(pixels);
}

} // namespace patina
