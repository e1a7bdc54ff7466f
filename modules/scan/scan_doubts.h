// Why a scan may lie on its mesh badly though each is right: another unit, another size, a mirror.
#pragma once

#include <string>
#include <vector>

#include "acquisition/registration/register_path.h"

namespace patina {

// Lines for a person; none where nothing is amiss, and none of a scale where a motion is free,
// which a scale would pass for. A path that lies where it was `found` is asked for a scale that
// differs from one by more than four deviations and half a percent. One that lies nowhere is tried
// in other units and mirrored, too. `fitting` is how it was found.
std::vector<std::string> scanDoubts(const SurfaceTarget& target, const std::vector<Vec3>& points,
                                    const RegistrationOptions& fitting, const Registration& found,
                                    Progress& progress);

} // namespace patina
