// What every scene's picture has: lights, materials, the axes in the corner.
#pragma once

#include <vtkActor.h>
#include <vtkAxesActor.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/types.h"
#include "visualization/values/lettering.h"

namespace patina {

// Of x, y and z, wherever they are drawn.
inline constexpr palette::Color kAxisColors[] = {
    {0.76, 0.23, 0.20}, {0.25, 0.56, 0.27}, {0.20, 0.38, 0.72}};

// An actor with an empty mapper and the matt material of all surfaces.
vtkSmartPointer<vtkActor> surfaceActor(const palette::Color& color);
// Of objects that are drawn in their own frame.
void place(vtkActor& actor, const Pose& world_from_object);
// Three lamps that go with the camera.
void addLights(vtkRenderer& renderer);
vtkSmartPointer<vtkAxesActor> axesActor();
void setLettering(vtkAxesActor& axes, const Lettering& letters);
void setBackground(vtkRenderer& renderer, const palette::Ground& ground);

} // namespace patina
