// Corrects the unit and the upper axis of an object whose file was read with others.
#pragma once

#include <string>

#include "geometry/mesh/mesh_unit.h"
#include "scene/scene.h"

namespace patina {

// Metres of one unit `now` over those of one unit `was`; neither is MeshUnit::fit.
double unitRatio(MeshUnit was, MeshUnit now);

// Scales the object's mesh as if its file had been read in `now`, and turns the object as a file in
// which y points up is turned; the pins of a scene of one object go along. `asked`: the mesh for
// which this was asked. Throws Error if the object has another one or is not there, if it would be
// too large, in a scene with scans, whose poses on the mesh would be wrong, and in one of several
// objects with pins.
Scene withReread(Scene scene, const std::string& object, const TriangleMesh* asked, MeshUnit was,
                 MeshUnit now, UpAxis up);

} // namespace patina
