#include "visualization/values/scalar_bar.h"

#include <algorithm>

#include <vtkProperty2D.h>
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
  // Of what is no value: a tag beside its swatch.
  vtkTextProperty* tag = bar->GetAnnotationTextProperty();
  tag->ShallowCopy(bar->GetLabelTextProperty());
  tag->SetBackgroundColor(palette::forVtk(palette::kBackgroundHigh));
  tag->SetBackgroundOpacity(1);
  bar->SetBarRatio(0.22);
  // Its own plate: what lies behind never mixes with the colours that are read.
  bar->DrawBackgroundOn();
  bar->GetBackgroundProperty()->SetColor(palette::forVtk(palette::kBackgroundHigh));
  bar->SetTextPad(6);
  bar->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  bar->SetHeight(0.5);
  placeScalarBar(*bar, 0, 0.12);
  return bar;
}

double scalarBarShare(int wide, int text_size) {
  return wide > 0 ? std::clamp(8.8 * text_size / wide, 0.12, 0.3) : 0.12;
}

void placeScalarBar(vtkScalarBarActor& bar, int place, double share) {
  bar.SetWidth(share - 0.01);
  bar.SetPosition(1 - share * (place + 1), 0.26);
}

void setTextSize(vtkScalarBarActor& bar, int pixels) {
  for (vtkTextProperty* text :
       {bar.GetTitleTextProperty(), bar.GetLabelTextProperty(), bar.GetAnnotationTextProperty()})
    text->SetFontSize(pixels);
}

} // namespace patina
