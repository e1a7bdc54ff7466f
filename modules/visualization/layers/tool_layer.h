// The tool as the hand feels it: held out by the surface, with what it hides (the true tip, the
// contact point, the force) drawn over everything.
#pragma once

#include <optional>

#include <vtkActor.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include "scene/tool_sample.h"
#include "visualization/values/lettering.h"

namespace patina {

// Where contact is seen: on the original surface below the VCP (K12). An offset and a tip's radius
// are between the two; friction, which holds the VCP back from the tip, holds this point as well.
Vec3 seenContact(const ToolSample& sample);

class ToolLayer {
 public:
  // scene: hidden by surfaces in front of it; overlay: never hidden.
  ToolLayer(vtkRenderer& scene, vtkRenderer& overlay);

  // Of the tip [m]; 0 = a point, drawn as a ball of constant size in the picture.
  void setTipRadius(double radius);
  void update(const ToolSample& sample);
  // The shaft leans towards the viewer's upper right, so that it never hides its own tip; shaft and
  // arrow keep their size in the picture, whatever the zoom.
  void faceCamera(vtkCamera& camera);
  void setVisible(bool on);
  void setLettering(const Lettering& letters);
  // A square at the picture's lower left that the force's number keeps off [pixels].
  void setCorner(double side) { corner_ = side; }
  // Of the force, for the camera last faced; nullopt where none is drawn.
  std::optional<Vec3> arrowEnd() const;

 private:
  void place();
  double ballRadius() const;                // [m]
  double arrowLength(double newtons) const; // [m]
  // In its pixels, for the overlay's camera; nullopt where there is no picture.
  std::optional<Vec2> inPicture(const Vec3& p) const;
  bool isOutside(const Vec3& p) const;
  void placeNumber(const Vec3& end, const Vec3& direction, double newtons);

  vtkRenderer& overlay_;
  vtkSmartPointer<vtkActor> ball_, neck_, shaft_; // the proxy
  vtkSmartPointer<vtkActor> ghost_, spring_, stem_, contact_, arrow_shaft_, arrow_head_;
  vtkSmartPointer<vtkTextActor> label_;
  ToolSample sample_;
  Vec3 right_ = Vec3::UnitX(); // of the picture
  bool leftwards_ = false;     // the force's number stands left of its arrow
  Vec3 lean_ = Vec3(0.4, 0.7, 0.6).normalized();
  double tip_radius_ = 0;
  double length_ = 0.1; // height of the picture at the focal point [m]
  double corner_ = 0;
  bool visible_ = false;
};

} // namespace patina
