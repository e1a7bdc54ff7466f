// Translucent mirror plane of a stroke.
#pragma once

#include <array>

#include <vtkActor.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/types.h"
#include "visualization/values/palette.h"

namespace patina {

using MirrorState = std::array<Vec3, 4>; // corners in order [m], world

class MirrorLayer {
 public:
  MirrorLayer(vtkRenderer& scene, const MirrorState& place); // it outlives this layer
  ~MirrorLayer();
  MirrorLayer(const MirrorLayer&) = delete;
  MirrorLayer& operator=(const MirrorLayer&) = delete;
  void setBackgroundStyle(const palette::BackgroundStyle& ground);

 private:
  vtkRenderer& scene_;
  vtkSmartPointer<vtkActor> fill_, rim_;
};

} // namespace patina
