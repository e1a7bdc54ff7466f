// Draws the tool at the proxy, and in front of everything what the surface hides: the true tip, the
// contact point and the force.
#pragma once

#include <optional>

#include <vtkActor.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include "scene/tool_sample.h"
#include "visualization/values/text_style.h"

namespace patina {

// Contact point on the original surface below the contact point (K12). An offset and a tip's radius
// lie between them; friction, which holds back the contact point, holds back this point too.
Vec3 seenContact(const ToolSample& sample);

class ToolLayer {
 public:
  // front: hidden by surfaces before it; overlay: never hidden.
  ToolLayer(vtkRenderer& front, vtkRenderer& overlay);

  // Tip radius [m]; 0 = a point, drawn as a ball of constant size in the picture.
  void setTipRadius(double radius);
  // `nearest`: the surface point nearest to a free tip, to which a line with its length is drawn.
  void update(const ToolSample& sample, const std::optional<Vec3>& nearest = {});
  const std::optional<Vec3>& nearest() const { return nearest_; }
  // The shaft leans towards the viewer's upper right, so that it never hides its own tip. Shaft and
  // arrow keep their size in the picture.
  void faceCamera(vtkCamera& camera);
  void setVisible(bool on);
  void setTextStyle(const TextStyle& letters);
  // Square at the picture's lower left that the force's number avoids [pixels].
  void setCorner(double side) { corner_ = side; }
  // Tip of the force arrow for the last faceCamera(); nullopt if it is not drawn.
  std::optional<Vec3> arrowEnd() const;

 private:
  void place();
  double ballRadius() const;                // [m]
  double arrowLength(double newtons) const; // [m]
  // Position in pixels for the overlay's camera; nullopt if there is no picture.
  std::optional<Vec2> inPicture(const Vec3& p) const;
  bool isOutside(const Vec3& p) const;
  int distanceBeside() const; // a number's, from what it belongs to [pixels]
  void placeGap();
  void placeNumber(const Vec3& end, const Vec3& direction, double newtons);

  vtkRenderer& overlay_;
  vtkSmartPointer<vtkActor> ball_, neck_, shaft_; // the proxy
  vtkSmartPointer<vtkActor> ghost_, spring_, stem_, contact_, arrow_shaft_, arrow_head_, gap_;
  vtkSmartPointer<vtkTextActor> label_, gap_label_;
  ToolSample sample_;
  std::optional<Vec3> nearest_;
  Vec3 right_ = Vec3::UnitX(); // picture's right in the world
  bool leftwards_ = false;     // the number is left of its arrow
  Vec3 lean_ = Vec3(0.4, 0.7, 0.6).normalized();
  double tip_radius_ = 0;
  double length_ = 0.1; // height of the picture at the focal point [m]
  double corner_ = 0;
  bool visible_ = false;
};

} // namespace patina
