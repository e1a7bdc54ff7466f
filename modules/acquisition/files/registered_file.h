// A path in a mesh's frame, with where on the mesh each sample belongs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/registration/register_path.h"
#include "acquisition/scan_samples.h"
#include "acquisition/texture/texture_coordinates.h"

namespace patina {

// The columns of a path, then face,b0,b1,b2,distance [m]. Samples that do not count are left out.
void writeRegisteredPath(const std::filesystem::path& path, const std::vector<PathSample>& samples,
                         const Registration& registration);
std::string registeredText(const std::vector<PathSample>& samples,
                           const Registration& registration);

// The report of `patina register` says where a scan lies on its mesh. Throws FileError.
struct RegistrationReport {
  Pose mesh_from_scan = Pose::Identity();
  std::optional<double> compliance; // of the surface [m/N]; absent where nobody asked
};
RegistrationReport readRegistrationReport(const std::filesystem::path& path);

// Strokes of such a file, of any path's (t [s],x [m],y [m],z [m], ...) or of points alone (x [m],
// y [m],z [m], ...): one wherever the time between two samples is more than five times the median.
// Throws FileError: another header, a bad number, time that does not increase, no point. Appends to
// `warnings` a line for each file that has columns which are left out.
// `along` of those that the heights of such a scan have it for (t [s],along [m], ...); others are
// left out then. Throws FileError for heights of another scan.
std::vector<PathOnMesh> readStrokes(const std::filesystem::path& path,
                                    const std::filesystem::path& heights = {},
                                    std::vector<std::string>* warnings = nullptr);

} // namespace patina
