// Draws the band in which an offset or a magnet acts.
#pragma once

#include <vtkActor.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include "visualization/values/text_style.h"
#include "visualization/values/touch_band.h"

namespace patina {

// Outer edge of the offset's or magnet's band as a translucent shell, with a legend.
class BandLayer {
 public:
  // scene: renderer of the shell; overlay: renderer of the legend.
  BandLayer(vtkRenderer& scene, vtkRenderer& overlay);

  // The shell is absent where the field does not contain the band; the legend then gives the
  // reason.
  void update(const SurfaceField& field, const TouchBand& band);
  // The legend alone belongs to the tint of a slice.
  void setVisible(bool shell, bool legend) {
    shell_->SetVisibility(shell);
    legend_->SetVisibility(legend);
  }
  void setTextStyle(const TextStyle& letters);
  vtkActor& shell() { return *shell_; } // the slice cuts it

 private:
  vtkSmartPointer<vtkActor> shell_;
  vtkSmartPointer<vtkTextActor> legend_;
};

} // namespace patina
