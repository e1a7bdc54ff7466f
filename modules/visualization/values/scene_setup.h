// Scene setup: lights, materials and the axes in the corner.
#pragma once

#include <vtkActor.h>
#include <vtkAxesActor.h>
#include <vtkOutlineSource.h>
#include <vtkPolyDataAlgorithm.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/types.h"
#include "visualization/values/text_style.h"

namespace patina {

// Colours of the x, y and z axes.
inline constexpr palette::Color kAxisColors[] = {
    {0.76, 0.23, 0.20}, {0.25, 0.56, 0.27}, {0.20, 0.38, 0.72}};

// An actor with an empty mapper and the matt material of all surfaces.
vtkSmartPointer<vtkActor> surfaceActor(const palette::Color& color);
vtkPolyDataMapper& mapperOf(vtkActor& actor); // the actor must have one
// The same actor, with the source's output. The source is not kept.
vtkSmartPointer<vtkActor> surfaceActor(vtkPolyDataAlgorithm& source, const palette::Color& color);
// Sets the pose of an actor whose data are in the object frame.
void place(vtkActor& actor, const Pose& world_from_object);
void addLights(vtkRenderer& renderer);
// Lines along the edges of the source's box, without light.
vtkSmartPointer<vtkActor> outlineActor(vtkOutlineSource& source);
vtkSmartPointer<vtkAxesActor> axesActor();
void setTextStyle(vtkAxesActor& axes, const TextStyle& letters);
void setBackground(vtkRenderer& renderer, const palette::BackgroundStyle& ground);

} // namespace patina
