#include "visualization/layers/band_layer.h"

#include <vtkProperty.h>
#include <vtkTextProperty.h>

#include "field/surface/iso_surface.h"
#include "visualization/surfaces/surface_data.h"
#include "visualization/values/scene_setup.h"

namespace patina {

BandLayer::BandLayer(vtkRenderer& scene, vtkRenderer& overlay)
    : shell_(surfaceActor(palette::kOffsetBand)), legend_(vtkSmartPointer<vtkTextActor>::New()) {
  shell_->GetProperty()->SetOpacity(0.30);
  // The far side would only dim the object.
  shell_->GetProperty()->BackfaceCullingOn();
  // The renderer would otherwise guess from the opacity and might draw the shell first.
  shell_->ForceTranslucentOn();
  scene.AddActor(shell_);

  vtkTextProperty* text = legend_->GetTextProperty();
  text->BoldOn();
  text->SetVerticalJustificationToTop();
  legend_->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  legend_->SetPosition(0.014, 0.975);
  overlay.AddActor2D(legend_);
  setVisible(false, false);
}

void BandLayer::update(const SurfaceField& field, const TouchBand& band) {
  mapperOf(*shell_).SetInputData(isStored(band, field) ? surfaceData(isoSurface(field, band.edge))
                                                       : vtkSmartPointer<vtkPolyData>::New());
  const palette::Color& color = bandColor(band);
  shell_->GetProperty()->SetColor(palette::forVtk(color));
  legend_->SetInput((" " + bandLegend(band, field) + " ").c_str());
}

void BandLayer::setTextStyle(const TextStyle& letters) {
  palette::Color color;
  shell_->GetProperty()->GetColor(color.data());
  write(*legend_->GetTextProperty(), letters, color, true);
}

} // namespace patina
