#include "acquisition/calibration/rig_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/calibration/pivot.h"
#include "acquisition/tracking/marker_residual.h"
#include "acquisition/tracking/track_frames.h"
#include "acquisition/values/orientation.h"
#include "core/error.h"
#include "core/numbers.h"
#include "core/percentiles.h"

namespace patina {
namespace {

constexpr double kMostSearched = 600; // frames in which markers are searched
constexpr double kViewLength = 0.15;  // shift between two views that counts as much as 1 rad [m]

// A marker that most frames see this far from its place may be another one's; farther still, it is
// elsewhere on the rig. Glue and print explain less.
constexpr double kElsewhere = 15e-3, kElsewhereTurn = 0.5; // [m], [rad]
constexpr double kMisplaced = 8e-3, kMisturned = 0.25;     // [m], [rad]
constexpr double kMovedPlace = 5e-3, kMovedAngle = 0.2;    // deviations of its place then
constexpr std::size_t kMostSamples = 60, kFewestSamples = 5;

// Windows in which the tip may stand in a dimple.
constexpr double kDimpleWindow = 3, kDimpleStep = 1;                       // [s]
constexpr double kDimpleRms = 1.2e-3, kSameTip = 4e-3, kSameDimple = 3e-3; // [m]
constexpr double kDimpleMove = 15e-3; // smallest motion of the rig about a tip at rest [m]

bool isOf(const SeenMarker& seen, const RigMarker& marker) {
  return seen.id == marker.id && seen.family == marker.family;
}

std::size_t countIn(const RigView& view, const std::vector<RigMarker>& rig) {
  return static_cast<std::size_t>(std::count_if(
      rig.begin(), rig.end(), [&](const RigMarker& marker) { return imageOf(marker, view); }));
}

// Returns the pose that most others are near, or nullopt if no half of them agrees.
std::optional<Pose> consensusOf(const std::vector<Pose>& poses) {
  const std::size_t step = std::max<std::size_t>(1, poses.size() / kMostSamples);
  double least = INFINITY, within = 0, count = 0;
  std::optional<Pose> best;
  for (std::size_t i = 0; i < poses.size(); i += step) {
    double cost = 0, near = 0;
    count = 0;
    for (std::size_t k = 0; k < poses.size(); k += step, ++count) {
      const double apart = (poses[i].translation() - poses[k].translation()).norm() / kMisplaced +
                           angleBetween(poses[i], poses[k]) / kMisturned;
      cost += std::min(apart, 2.);
      near += apart < 2;
    }
    if (cost < least) {
      least = cost;
      within = near;
      best = poses[i];
    }
  }
  if (count < kFewestSamples || 2 * within < count) return std::nullopt;
  return best;
}

bool areNear(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm() < kMisplaced && angleBetween(a, b) < kMisturned;
}

// Names what became of a marker that was found far from its place, and improves the place where it
// is known. Returns false if the place is not far enough to be another one.
bool explainPlace(std::size_t i, const std::vector<RigMarker>& rig, double place, double angle,
                  MarkerStart& start) {
  for (int quarters = 0; quarters < 4; ++quarters)
    for (std::size_t k = 0; k < rig.size(); ++k) {
      if (k == i && quarters == 0) continue;
      Pose pose = rig[k].probe_from_marker;
      pose.rotate(Eigen::AngleAxisd(quarters * std::numbers::pi / 2, Vec3::UnitZ()));
      if (!areNear(pose, start.probe_from_marker)) continue;
      start = {pose, place, angle,
               k == i ? "is turned by " + std::to_string(90 * quarters) + " degrees"
                      : "is where marker " + std::to_string(rig[k].id) + " should be"};
      return true;
    }
  const Pose& nominal = rig[i].probe_from_marker;
  return (nominal.translation() - start.probe_from_marker.translation()).norm() > kElsewhere ||
         angleBetween(nominal, start.probe_from_marker) > kElsewhereTurn;
}

} // namespace

const SeenMarker* imageOf(const RigMarker& marker, const RigView& view) {
  const SeenMarker* found = nullptr;
  for (const SeenMarker& seen : view.markers) {
    if (!isOf(seen, marker)) continue;
    if (found) return nullptr;
    found = &seen;
  }
  return found;
}

ViewPoses posesIn(const std::vector<RigView>& views, const std::vector<RigMarker>& rig,
                  const Camera& camera) {
  ViewPoses poses;
  for (const RigView& view : views) {
    poses.emplace_back();
    if (countIn(view, rig) < std::min<std::size_t>(2, rig.size())) continue;
    const SeenRig seen = poseOf(view.markers, rig, camera);
    const bool posed = seen.verdict == RigVerdict::seen || seen.verdict == RigVerdict::misfit;
    if (posed && seen.camera_from_probe.translation().z() > 0)
      poses.back() = seen.camera_from_probe;
  }
  return poses;
}

std::vector<MarkerStart> startOf(const std::vector<RigView>& views,
                                 const std::vector<RigMarker>& rig, const Camera& camera,
                                 double place, double angle) {
  const std::size_t count = rig.size();
  std::vector<MarkerStart> starts;
  for (const RigMarker& marker : rig)
    starts.push_back({marker.probe_from_marker, place, angle, ""});
  std::vector<ViewPoses> alone(count); // camera_from_marker of each marker by itself
  for (std::size_t i = 0; i < count; ++i) {
    RigMarker bare = rig[i];
    bare.probe_from_marker = Pose::Identity();
    for (const RigView& view : views) {
      const SeenMarker* image = imageOf(bare, view);
      const SeenRig seen = image ? poseOf({*image}, {bare}, camera) : SeenRig();
      alone[i].push_back(seen.verdict == RigVerdict::seen ? std::optional(seen.camera_from_probe)
                                                          : std::nullopt);
    }
  }
  const auto besides = [&](std::size_t i, std::size_t k) { // marker_i_from_marker_k in each view
    std::vector<Pose> samples;
    for (std::size_t v = 0; v < views.size(); ++v)
      if (alone[i][v] && alone[k][v]) samples.push_back(alone[i][v]->inverse() * *alone[k][v]);
    return samples;
  };
  // Markers that lie beside each other as they should form groups; those of the largest one are in
  // their places.
  std::vector<std::size_t> group(count);
  for (std::size_t i = 0; i < count; ++i) group[i] = i;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = i + 1; k < count; ++k) {
      const std::optional<Pose> found = consensusOf(besides(i, k));
      if (!found || !areNear(*found, rig[i].probe_from_marker.inverse() * rig[k].probe_from_marker))
        continue;
      const std::size_t other = group[k];
      std::replace(group.begin(), group.end(), other, group[i]);
    }
  std::size_t largest = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (std::count(group.begin(), group.end(), group[i]) >
        std::count(group.begin(), group.end(), largest))
      largest = group[i];
  for (std::size_t k = 0; k < count; ++k) {
    if (group[k] == largest) continue;
    std::vector<Pose> samples;
    for (std::size_t i = 0; i < count; ++i) {
      if (group[i] != largest) continue;
      for (const Pose& pose : besides(i, k)) samples.push_back(rig[i].probe_from_marker * pose);
    }
    const std::optional<Pose> found = consensusOf(samples);
    if (!found || areNear(*found, rig[k].probe_from_marker)) continue;
    MarkerStart start{*found, kMovedPlace, kMovedAngle, "is elsewhere"};
    if (explainPlace(k, rig, place, angle, start)) starts[k] = start;
  }
  return starts;
}

std::vector<std::size_t> unlikeViews(const ViewPoses& poses,
                                     const std::vector<std::size_t>& candidates, std::size_t most) {
  std::vector<std::size_t> chosen;
  std::vector<double> apart(candidates.size(), INFINITY);
  std::size_t next = 0;
  while (chosen.size() < std::min(most, candidates.size())) {
    chosen.push_back(candidates[next]);
    const Pose& last = *poses[candidates[next]];
    apart[next] = -1;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const Pose& pose = *poses[candidates[i]];
      const double off =
          0.5 * (pose.linear() - last.linear()).squaredNorm() +
          (pose.translation() - last.translation()).squaredNorm() / (kViewLength * kViewLength);
      apart[i] = std::min(apart[i], off);
    }
    next = static_cast<std::size_t>(std::max_element(apart.begin(), apart.end()) - apart.begin());
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

Dimples dimplesIn(const std::vector<RigView>& views, const ViewPoses& poses) {
  struct Window {
    PivotFit fit;
    std::size_t first, end;
  };
  std::vector<Window> windows;
  for (std::size_t first = 0; first < views.size();) {
    std::vector<CameraPose> turning;
    Box3 moved;
    std::size_t end = first, next = views.size();
    for (; end < views.size() && views[end].t < views[first].t + kDimpleWindow; ++end) {
      if (views[end].t >= views[first].t + kDimpleStep) next = std::min(next, end);
      if (!poses[end]) continue;
      CameraPose pose;
      pose.t = views[end].t;
      pose.position = poses[end]->translation();
      pose.orientation = Eigen::Quaterniond(poses[end]->linear());
      moved.extend(pose.position);
      turning.push_back(pose);
    }
    const auto fit = turning.size() >= 10 && moved.diagonal().norm() > kDimpleMove
                         ? fitPivot(turning)
                         : std::nullopt;
    if (fit && fit->rms < kDimpleRms && 4 * fit->rejected < turning.size())
      windows.push_back({*fit, first, end});
    first = std::max(first + 1, next);
  }
  // The tip on which most windows agree.
  std::size_t most = 0;
  Dimples found;
  for (const Window& window : windows) {
    std::vector<double> x, y, z;
    for (const Window& other : windows) {
      if ((other.fit.tip - window.fit.tip).norm() > kSameTip) continue;
      x.push_back(other.fit.tip.x()), y.push_back(other.fit.tip.y()),
          z.push_back(other.fit.tip.z());
    }
    if (x.size() <= most) continue;
    most = x.size();
    found.tip = {percentiles(x).p50, percentiles(y).p50, percentiles(z).p50};
  }
  if (most < 2) return {};
  for (const Window& window : windows) {
    if ((window.fit.tip - found.tip).norm() > kSameTip) continue;
    if (found.dimples.empty() ||
        (found.dimples.back().point - window.fit.point).norm() > kSameDimple)
      found.dimples.push_back({window.fit.point, {}});
    Dimple& dimple = found.dimples.back();
    for (std::size_t v = window.first; v < window.end; ++v)
      if (poses[v] && (dimple.views.empty() || dimple.views.back() < v) &&
          (*poses[v] * found.tip - dimple.point).norm() < kSameDimple)
        dimple.views.push_back(v);
  }
  return found;
}

RigViews viewsOfRig(FrameSource& frames, const std::vector<RigMarker>& markers,
                    const Camera& camera, const FinderOptions& finder, const std::string& from,
                    Progress& progress) {
  RigViews found;
  found.camera = camera;
  const std::vector<CodeBook> books = codeBooksOf(markers);
  const std::optional<std::size_t> count = frames.count();
  const std::size_t step =
      count ? std::max<std::size_t>(1, static_cast<std::size_t>(
                                           std::ceil(static_cast<double>(*count) / kMostSearched)))
            : 1;
  const std::size_t left_out = frames.keepEach(step) ? 1 : step;
  bool sized = false;
  for (std::size_t i = 0; const std::optional<SourceFrame> frame = frames.next(); ++i) {
    if (progress.cancelled() && frames.isLive()) break;
    progress.throwIfCancelled();
    if (count)
      progress.report(0.9 * std::min(1., static_cast<double>(i * step / left_out) /
                                             static_cast<double>(*count)),
                      "markers");
    if (!frame->fault.empty() || i % left_out != 0) continue;
    if (!sized) found.camera = cameraOf(frame->image, camera, frame->name);
    sized = true;
    requireSize(frame->image, found.camera, frame->name);
    ++found.frames;
    RigView view{frame->t, findMarkers(frame->image, books, &found.camera, finder)};
    if (!view.markers.empty()) found.views.push_back(std::move(view));
  }
  found.notes = frames.notes();
  if (found.views.empty())
    throw FileError(from, 0,
                    "no frame of " + formatCount(found.frames) +
                        " shows a marker of the rig: look at the rig's families and ids, at light "
                        "and focus");
  return found;
}

} // namespace patina
