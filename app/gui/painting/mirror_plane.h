// Where the plane lies across which a brush is mirrored.
#pragma once

#include "scene/scene.h"
#include "scene/stroke.h"
#include "visualization/layers/mirror_layer.h"

namespace patina {

// Through the middle of the object's box and a little beyond it; symmetry is not none.
MirrorPlace mirrorPlane(const SceneObject& object, Symmetry symmetry);

} // namespace patina
