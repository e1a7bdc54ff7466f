// An off-screen window in which a view has the looks of a figure. Internal to the module.
#pragma once

#include <map>
#include <string>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>

#include "visualization/values/figure.h"
#include "visualization/view/figure_picture.h"
#include "visualization/view/scene_view.h"

namespace patina {

// Moves a view into a window of its own, and back when destroyed. A view that was in no window is
// fitted unless the figure keeps its camera. Throws Error without a display or memory, and for
// sides out of range.
class FigureStage {
 public:
  FigureStage(SceneView& view, const Figure& figure);
  ~FigureStage();
  FigureStage(const FigureStage&) = delete;
  FigureStage& operator=(const FigureStage&) = delete;

  // Red, green and blue, in rows from the bottom.
  vtkSmartPointer<vtkImageData> draw();
  vtkSmartPointer<vtkImageData> drawOver(double grey);
  vtkRenderWindow& window() { return *window_; }

 private:
  SceneView& view_;
  double magnification_;
  vtkRenderWindow* shown_in_;
  palette::BackgroundStyle style_;
  std::map<vtkRenderer*, bool> smoothed_; // FXAA makes every pixel opaque
  const vtkNew<vtkRenderWindow> window_;
};

// Draws the view in the stage, which was made for this figure. Throws Error if nothing is drawn.
FigurePicture drawFigure(FigureStage& stage, const Figure& figure);
std::string figurePng(const FigurePicture& picture);

} // namespace patina
