// Default options for registering a scan's path, shared by command, window and studies.
#pragma once

#include "acquisition/registration/register_path.h"
#include "acquisition/values/scan_samples.h"

namespace patina {

// Uses the median of the samples' deviations as noise and averages samples within a 200th of the
// path's radius. Estimates the compliance if there are forces, and searches alternative poses.
RegistrationOptions defaultOptions(const std::vector<PathSample>& path);

// Returns the search options for an unknown pose.
CoarseSearch globalSearch(const SurfaceTarget& target);

} // namespace patina
