// The edge of the offset's or magnet's band as a shell that one sees through, and what it is.
#pragma once

#include <vtkActor.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include "field/store/surface_field.h"
#include "visualization/values/lettering.h"
#include "visualization/values/touch_band.h"

namespace patina {

class BandLayer {
 public:
  // scene: where the shell is; overlay: where the legend is.
  BandLayer(vtkRenderer& scene, vtkRenderer& overlay);

  // A band that the field does not hold has a legend that says so, and no shell.
  void update(const SurfaceField& field, const TouchBand& band);
  // The legend alone goes with the tint of a slice.
  void setVisible(bool shell, bool legend);
  void setLettering(const Lettering& letters);
  vtkActor& shell() { return *shell_; } // to be cut by the slice

 private:
  vtkSmartPointer<vtkActor> shell_;
  vtkSmartPointer<vtkTextActor> legend_;
};

} // namespace patina
