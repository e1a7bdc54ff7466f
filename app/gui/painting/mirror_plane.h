// The plane across which a brush is mirrored.
#pragma once

#include "scene/scene.h"
#include "scene/stroke.h"
#include "visualization/layers/mirror_layer.h"

namespace patina {

// Returns a plane through the centre of the object's box. There must be a symmetry.
MirrorState mirrorPlane(const SceneObject& object, Symmetry symmetry);

} // namespace patina
