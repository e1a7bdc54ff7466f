// Writes a simulated hand's scan folder, as a camera and a probe would.
#pragma once

#include <filesystem>

#include "acquisition/simulation/simulated_frames.h"
#include "acquisition/values/camera.h"
#include "core/progress.h"

namespace patina {

// 640 x 480, with a field of view of a hand's breadth at 0.4 m.
Camera usualCamera();

// Returns camera_from_plane, 0.4 m from a point `over` the box's center [m]; z is up.
Pose cameraOver(const Box3& box, double over);

// Writes frames/, frames.csv and camera.yml of a rig as it really is; returns the number of frames.
// Throws FileError, Cancelled; Error for an unknown family.
std::size_t writeFrames(const std::filesystem::path& folder, const Camera& camera,
                        const ProbeMotion& camera_from_probe, double seconds,
                        const std::vector<RigMarker>& markers, const CaptureSettings& course,
                        Progress& progress);

} // namespace patina
