#include "visualization/layers/band_layer.h"

#include <vtkCoordinate.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTextProperty.h>

#include "field/surface/iso_surface.h"
#include "visualization/surfaces/surface_data.h"
#include "visualization/values/palette.h"
#include "visualization/view/scene_furniture.h"

namespace patina {

BandLayer::BandLayer(vtkRenderer& scene, vtkRenderer& overlay)
    : shell_(surfaceActor(palette::kOffsetBand)), legend_(vtkSmartPointer<vtkTextActor>::New()) {
  shell_->GetProperty()->SetOpacity(0.30);
  // Its far side would only dim the object.
  shell_->GetProperty()->BackfaceCullingOn();
  // Opaque things first, whatever the renderer guesses.
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
  auto* mapper = vtkPolyDataMapper::SafeDownCast(shell_->GetMapper());
  mapper->SetInputData(isStored(band, field) ? surfaceData(isoSurface(field, band.edge))
                                             : vtkSmartPointer<vtkPolyData>::New());
  const palette::Color& color = bandColor(band);
  shell_->GetProperty()->SetColor(palette::forVtk(color));
  legend_->SetInput((" " + bandLegend(band, field) + " ").c_str());
}

void BandLayer::setVisible(bool shell, bool legend) {
  shell_->SetVisibility(shell);
  legend_->SetVisibility(legend);
}

void BandLayer::setLettering(const Lettering& letters) {
  palette::Color color;
  shell_->GetProperty()->GetColor(color.data());
  write(*legend_->GetTextProperty(), letters, color, true);
}

} // namespace patina
