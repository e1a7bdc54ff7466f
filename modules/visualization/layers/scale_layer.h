// Scale bar of a round length, valid at the distance of the camera's focal point.
#pragma once

#include <vtkActor2D.h>
#include <vtkCamera.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include "visualization/values/text_style.h"

namespace patina {

// Largest 1, 2 or 5 times a power of ten that is at most `most` > 0 [m].
double roundLength(double most);

class ScaleLayer {
 public:
  explicit ScaleLayer(vtkRenderer& overlay);
  void setVisible(bool on) {
    bar_->SetVisibility(on);
    words_->SetVisibility(on);
  }
  // Call before a render; `high` is the picture's height [pixels].
  void update(vtkCamera& camera, int high, const TextStyle& letters);

 private:
  vtkSmartPointer<vtkActor2D> bar_;
  vtkSmartPointer<vtkTextActor> words_;
};

} // namespace patina
