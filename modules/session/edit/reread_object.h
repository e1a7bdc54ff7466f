// Corrects the unit and the upper axis of an object whose file was read with others.
#pragma once

#include <string>

#include "geometry/mesh/mesh_unit.h"
#include "scene/scene.h"

namespace patina {

// Metres of one unit `now` over those of one unit `was`; neither is MeshUnit::fit.
double unitRatio(MeshUnit was, MeshUnit now);

// Scales the object's mesh as if its file had been read in `now`, and turns the object about the
// world's x axis if y points up. Throws Error if the object is not there, if it would be too large,
// and for another size in a scene with scans, whose poses on the mesh would be wrong.
Scene withReread(Scene scene, const std::string& object, MeshUnit was, MeshUnit now, UpAxis up);

} // namespace patina
