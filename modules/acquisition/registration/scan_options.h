// How a scan's path is registered unless somebody says otherwise: one home for what the command,
// the window and the studies begin with.
#pragma once

#include "acquisition/registration/register_path.h"
#include "acquisition/scan_samples.h"

namespace patina {

// The noise is the median of what samples state, places are a 200th of the path's radius, how far
// the surface yields is found where the probe felt anything, and other places are looked for.
RegistrationOptions optionsFor(const std::vector<PathSample>& path);

// Where nothing is known of the place.
CoarseSearch anywhereOn(const SurfaceTarget& target);

} // namespace patina
