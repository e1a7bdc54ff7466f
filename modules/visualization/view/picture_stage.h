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
#include "visualization/view/kept_picture.h"

namespace patina {

struct PictureStage {
  // Bodies; what they hide or it hides, drawn after them from the same camera; what nothing hides.
  vtkNew<vtkRenderer> scene, foreground, overlay, corner;
  vtkSmartPointer<vtkAxesActor> axes;
  palette::BackgroundStyle ground = palette::kLight;
  bool dirty = true;       // the bodies have changed since the last finishFrame()
  bool front_dirty = true; // what the other renderers draw has changed

  PictureStage();
  void setUp(); // call once, when the scene has its actors
  void attachTo(vtkRenderWindow& window);
  void setGround(const palette::BackgroundStyle& style);
  // Renders bodies at half the resolution and scales them up, four times as fast with software
  // OpenGL; texts and bars stay sharp. For pictures in motion.
  void setHalfSize(bool on);
  // Smooth edges (FXAA) of bodies and what is before them; call after finishFrame().
  void setSmooth(bool on);

  vtkCamera& camera() const { return *scene->GetActiveCamera(); }
  std::array<int, 2> size() const; // [pixels]; zeros without a window
  TextStyle letters() const { return textStyleOf(scene->GetRenderWindow(), ground); }

  // Turns the corner's camera like the scene's, at this distance. The corner is a square, `share`
  // of the picture's height wide, or `lines` of text in small pictures. Returns its side [pixels].
  double placeCorner(double distance, double share, double lines);
  // Call last before a render. Returns true if the picture differs from the last one. In a window
  // of one sample per pixel the bodies are not drawn again while only `front_dirty` is set.
  bool finishFrame();
  bool keepsBodies() const { return kept_.has(); } // the next render does not draw them

 private:
  bool frontIsInRange() const; // the camera's range of depth holds it, as far as it can
  void setRange();
  void choosePass();

  vtkSmartPointer<vtkRenderPass> half_size_;
  bool is_half_size_ = false;
  bool changed_ = false;           // what finishFrame() has returned last
  std::array<double, 2> fitted_{}; // depths of the foreground that the range was set for [m]
  KeptPicture kept_{*scene};
  CameraState drawn_from_{};
  std::array<int, 2> drawn_size_{};
};

} // namespace patina
