// The plane across which a stroke is mirrored, seen through.
#pragma once

#include <array>

#include <vtkActor.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/types.h"
#include "visualization/values/palette.h"

namespace patina {

using MirrorPlace = std::array<Vec3, 4>; // its corners, one after another [m], world

class MirrorLayer {
 public:
  MirrorLayer(vtkRenderer& scene, const MirrorPlace& place); // which outlives it
  ~MirrorLayer();
  MirrorLayer(const MirrorLayer&) = delete;
  MirrorLayer& operator=(const MirrorLayer&) = delete;
  void setGround(const palette::Ground& ground);

 private:
  vtkRenderer& scene_;
  vtkSmartPointer<vtkActor> fill_, rim_;
};

} // namespace patina
