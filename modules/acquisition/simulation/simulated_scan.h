// A scan folder that a simulated hand leaves behind: what a camera and a probe would have written.
#pragma once

#include <filesystem>

#include "acquisition/camera.h"
#include "acquisition/simulation/simulated_frames.h"
#include "core/progress.h"

namespace patina {

// Of 640 x 480, wide enough for a hand's breadth at 0.4 m.
Camera usualCamera();

// camera_from_plane of one that looks at a point `over` the box's middle [m], z up, from above and
// from the side, 0.4 m away.
Pose cameraOver(const Box3& box, double over);

// The cube that simulated probes carry.
inline constexpr double kCubeEdge = 0.036; // [m]

// frames/, frames.csv and camera.yml; how many frames there are. Throws FileError, Cancelled; an
// Error for a family that there is not.
std::size_t writeFrames(const std::filesystem::path& folder, const Camera& camera,
                        const SimulatedHand& hand, const ProbeModel& probe,
                        const std::string& family, const FrameCourse& course, Progress& progress);

} // namespace patina
