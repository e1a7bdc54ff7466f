// Parts common to all pictures: renderers, background, axes in the corner, and the test for whether
// a frame differs from the last one. Internal to the module.
#pragma once

#include <array>

#include <vtkAxesActor.h>
#include <vtkNew.h>
#include <vtkRenderPass.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "visualization/values/camera.h"
#include "visualization/values/text_style.h"

namespace patina {

struct PictureStage {
  vtkNew<vtkRenderer> scene, overlay, corner; // nothing hides the overlay
  vtkSmartPointer<vtkAxesActor> axes;
  palette::BackgroundStyle ground = palette::kLight;
  bool dirty = true; // the picture has changed since the last finishFrame()

  PictureStage();
  void setUp(); // call once, when the scene has its actors
  void attachTo(vtkRenderWindow& window);
  void setGround(const palette::BackgroundStyle& style);
  // Renders bodies at half the resolution and scales them up, four times as fast with software
  // OpenGL; texts and bars stay sharp. For pictures in motion.
  void setHalfSize(bool on);

  vtkCamera& camera() const { return *scene->GetActiveCamera(); }
  std::array<int, 2> size() const; // [pixels]; zeros without a window
  TextStyle letters() const { return textStyleOf(scene->GetRenderWindow(), ground); }

  // Turns the corner's camera like the scene's, at this distance. The corner is a square, `share`
  // of the picture's height wide, or `lines` of text in small pictures. Returns its side [pixels].
  double placeCorner(double distance, double share, double lines);
  // Call last before a render. Returns true if the picture differs from the last one.
  bool finishFrame();

 private:
  vtkSmartPointer<vtkRenderPass> half_size_;
  CameraState drawn_from_{};
  std::array<int, 2> drawn_size_{};
};

} // namespace patina
