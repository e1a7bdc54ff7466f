// What a picture says of a pose by how all faces look (A04): those too small or too askew to be
// read still look as they were printed.
#pragma once

#include "acquisition/camera.h"

namespace patina {

// By how much (natural logarithm) the picture is likelier with the rig in that pose than with
// anything else where its markers would be seen; 0 where none would be.
double faceLikeness(const GreyFrame& image, const std::vector<RigMarker>& rig, const Camera& camera,
                    const Pose& camera_from_probe);

} // namespace patina
