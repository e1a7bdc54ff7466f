#include "acquisition/tracking/track_frames.h"

#include <cmath>
#include <map>

#include "acquisition/tracking/rig_misfit.h"
#include "acquisition/values/orientation.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr double kMaxPoseAge = 0.15; // largest age of a previous pose [s]

} // namespace

CameraPose cameraPose(const SeenRig& seen, double t) {
  CameraPose pose;
  pose.t = t;
  pose.position = seen.camera_from_probe.translation();
  pose.orientation = Eigen::Quaterniond(seen.camera_from_probe.linear());
  pose.sigma_position = std::sqrt(seen.covariance.topLeftCorner<3, 3>().trace() / 3);
  pose.sigma_angle = std::sqrt(seen.covariance.bottomRightCorner<3, 3>().trace() / 3);
  return pose;
}

RigTracker::RigTracker(const Camera& camera, const std::vector<RigMarker>& rig,
                       const FinderOptions& options)
    : camera_(camera), rig_(rig), options_(options), books_(codeBooksOf(rig)) {}

std::vector<CodeBook> codeBooksOf(const std::vector<RigMarker>& rig) {
  std::vector<CodeBook> books;
  std::map<std::string, std::vector<int>> ids;
  for (const RigMarker& marker : rig) ids[marker.family].push_back(marker.id);
  for (const auto& [name, wanted] : ids) {
    const MarkerFamily& family = markerFamily(name);
    for (const int id : wanted)
      if (id >= static_cast<int>(family.code.size()))
        throw Error("marker " + std::to_string(id) + ": family " + name + " has ids 0 to " +
                    std::to_string(family.code.size() - 1));
    books.emplace_back(family, wanted);
  }
  return books;
}

SeenRig RigTracker::track(const GreyFrame& image, double t) {
  const bool previous_pose = last_ && std::abs(t - last_t_) < kMaxPoseAge;
  markers_ = findMarkers(image, books_, &camera_, options_);
  const SeenRig seen = poseOf(markers_, rig_, camera_, previous_pose ? &*last_ : nullptr, &image);
  if (seen.verdict == RigVerdict::seen) {
    last_ = seen.camera_from_probe;
    last_t_ = t;
  }
  return seen;
}

std::vector<std::string> warningsOf(const TrackedFrames& found, const std::string& frames,
                                    const std::filesystem::path& rig) {
  std::vector<std::string> lines = found.notes;
  const std::string of = " of " + formatCount(found.frames) + " frames ";
  if (found.unreadable > 0)
    lines.push_back(frames + ": " + formatCount(found.unreadable) + of +
                    "cannot be read; the first: " + found.first_fault);
  if (found.repeated > 0)
    lines.push_back(frames + ": in " + formatCount(found.repeated) + of +
                    "a marker of the rig is seen more than once and ignored; the first: " +
                    found.first_repeated + ": cover its other images or print it again");
  if (!found.rig_doubt.empty())
    lines.push_back(rig.string() + ": " + found.rig_doubt);
  else if (found.isOfAnotherRig())
    lines.push_back(rig.string() + ": in " + formatCount(found.poses.size()) + " frames " +
                    formatCount(found.dropped) +
                    " markers were not where it has them, so that poses may be those of the wrong "
                    "ones: look at ids, sizes and places, and at the camera's focal length");
  return lines;
}

TrackedFrames trackFrames(FrameSource& frames, const Camera& camera,
                          const std::vector<RigMarker>& rig, const FinderOptions& options,
                          Progress& progress, const FrameListener& listener) {
  RigTracker tracker(camera, rig, options);
  RigMisfit misfit(rig, camera);
  TrackedFrames result;
  double squares = 0, corners = 0;
  TurnedFrames turns;
  std::optional<Camera> shown; // camera, turned with the first frame
  const std::optional<std::size_t> count = frames.count();
  const auto goWithout = [&](double t, const SeenRig& seen, const std::string& why) {
    result.without.push_back({t, why});
    if (listener) listener(result.frames - 1, seen, why);
  };
  while (const std::optional<SourceFrame> frame = frames.next()) {
    if (progress.cancelled() && frames.isLive()) break;
    progress.throwIfCancelled();
    const double done = static_cast<double>(result.frames++);
    progress.report(count ? std::min(1., done / static_cast<double>(*count)) : 0, "frames");
    if (!frame->fault.empty()) {
      goWithout(frame->t, {}, frame->fault);
      if (result.unreadable++ == 0) result.first_fault = frame->fault;
      continue;
    }
    if (!shown) {
      shown = cameraOf(frame->image, camera, frame->name);
      tracker.setCamera(*shown);
      misfit.setCamera(*shown);
    }
    requireSize(frame->image, *shown, frame->name);
    turns.add(frame->image, frame->name);
    const SeenRig seen = tracker.track(frame->image, frame->t);
    result.dropped += seen.dropped;
    if (!seen.repeated.empty() && result.repeated++ == 0)
      result.first_repeated =
          "at " + formatNumber(frame->t) + " s " + textOf(seen.repeated.front());
    const bool posed = seen.verdict == RigVerdict::seen;
    misfit.add(tracker.markers(), seen, posed ? std::optional(result.poses.size()) : std::nullopt);
    if (!posed) {
      goWithout(frame->t, seen, reasonOf(seen));
      result.ambiguous += seen.verdict == RigVerdict::ambiguous;
      result.misfit += seen.verdict == RigVerdict::misfit;
      continue;
    }
    result.poses.push_back(cameraPose(seen, frame->t));
    if (listener) listener(result.frames - 1, seen, "");
    const double n = 4 * static_cast<double>(seen.markers);
    squares += n * seen.rms * seen.rms;
    corners += n;
  }
  result.rig_doubt = misfit.judge(result.poses).text;
  result.notes = frames.notes();
  if (const std::string line =
          turns.line(shown && shown->width != camera.width ? &camera : nullptr, kTurnedUnlike);
      !line.empty())
    result.notes.push_back(line);
  if (corners > 0) result.rms = std::sqrt(squares / corners);
  return result;
}

} // namespace patina
