// How long something is in the picture: a bar of a round length, that of a thing as far away as
// what the camera looks at.
#pragma once

#include <string>

#include <vtkActor2D.h>
#include <vtkCamera.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include "visualization/values/lettering.h"

namespace patina {

// The longest of 1, 2 or 5 times a power of ten that is no longer than `most` > 0 [m].
double roundLength(double most);

class ScaleLayer {
 public:
  explicit ScaleLayer(vtkRenderer& overlay);
  void setVisible(bool on);
  // Before a render, in a picture of that height [pixels].
  void update(vtkCamera& camera, int high, const Lettering& letters);

 private:
  vtkSmartPointer<vtkActor2D> bar_;
  vtkSmartPointer<vtkTextActor> words_;
};

} // namespace patina
