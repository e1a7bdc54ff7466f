// Views of a waved marker rig, and estimates from them before the rig is adjusted (A31): where its
// markers are about, which frames differ, when its tip stood still.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acquisition/sources/sources.h"
#include "acquisition/tracking/marker_finder.h"
#include "core/progress.h"

namespace patina {

// The markers that one frame shows.
struct RigView {
  double t = 0; // [s]
  std::vector<SeenMarker> markers;
};

struct RigViews {
  std::vector<RigView> views;     // frames that show a marker of the rig
  std::size_t frames = 0;         // frames that were searched
  std::vector<std::string> notes; // remarks about the source, one line each
  Camera camera;                  // the camera as the frames are turned
};
// Searches at most about 600 frames of a source for the markers, at even times. Throws FileError if
// the frames have several sizes or another one than the camera, and if no frame shows a marker
// (`from` names the source); Cancelled.
RigViews viewsOfRig(FrameSource& frames, const std::vector<RigMarker>& markers,
                    const Camera& camera, const FinderOptions& finder, const std::string& from,
                    Progress& progress);

// Returns the only image of a marker in a view, or nullptr.
const SeenMarker* imageOf(const RigMarker& marker, const RigView& view);

// Returns camera_from_probe for each view that shows two of the rig's markers, also where they
// contradict one another.
using ViewPoses = std::vector<std::optional<Pose>>;
ViewPoses posesIn(const std::vector<RigView>& views, const std::vector<RigMarker>& rig,
                  const Camera& camera);

// The place of a marker, and how well it is known.
struct MarkerStart {
  Pose probe_from_marker = Pose::Identity();
  double place = 0, angle = 0; // standard deviations along and about each axis [m], [rad]
  // "is where marker 2 should be", "is turned by 90 degrees", or "is elsewhere" where most frames
  // contradict the rig; else empty.
  std::string finding;
};
// Returns the rig's places, of these deviations, with those replaced that most frames contradict
// by centimetres or quarter turns.
std::vector<MarkerStart> startOf(const std::vector<RigView>& views,
                                 const std::vector<RigMarker>& rig, const Camera& camera,
                                 double place, double angle);

// Returns at most `most` of the candidates in order, each as unlike the others as possible.
std::vector<std::size_t> unlikeViews(const ViewPoses& poses,
                                     const std::vector<std::size_t>& candidates, std::size_t most);

// A place at which the tip stood while the probe turned about it.
struct Dimple {
  Vec3 point;                     // in the camera's frame [m]
  std::vector<std::size_t> views; // in order of time
};
struct Dimples {
  Vec3 tip = Vec3::Zero(); // in the probe's frame, to a few millimetres [m]
  std::vector<Dimple> dimples;
};
Dimples dimplesIn(const std::vector<RigView>& views, const ViewPoses& poses);

} // namespace patina
