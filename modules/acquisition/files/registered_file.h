// Paths in a mesh's frame, with the closest point of the mesh for each sample.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/registration/register_path.h"
#include "acquisition/texture/texture_coordinates.h"
#include "acquisition/values/scan_samples.h"

namespace patina {

// Columns of a path, then face,b0,b1,b2,distance [m]. Outliers are left out.
void writeRegisteredPath(const std::filesystem::path& path, const std::vector<PathSample>& samples,
                         const Registration& registration);
std::string registeredText(const std::vector<PathSample>& samples,
                           const Registration& registration);

// Pose of the scan on its mesh, from the report of `patina register`. Throws FileError.
struct RegistrationReport {
  Pose mesh_from_scan = Pose::Identity();
  std::optional<double> compliance; // compliance [m/N]; absent if not estimated
};
RegistrationReport readRegistrationReport(const std::filesystem::path& path);

// Reads the strokes of such a file, of any path (t [s],x [m],y [m],z [m], ...) or of points alone
// (x [m],y [m],z [m], ...). A new stroke begins where the time between two samples is more than
// five times the median. Throws FileError: another header, a bad number, time that does not
// increase, no point. Appends to `warnings` a line for each file with columns that are left out.
// `heights` (t [s],along [m], ...) gives the samples' arc length `along`; samples without one are
// left out then. Throws FileError for heights of another scan.
std::vector<PathOnMesh> readStrokes(const std::filesystem::path& path,
                                    const std::filesystem::path& heights = {},
                                    std::vector<std::string>* warnings = nullptr);

} // namespace patina
