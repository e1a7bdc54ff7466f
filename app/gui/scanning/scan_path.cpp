#include "app/gui/scanning/scan_path.h"

#include <algorithm>
#include <cmath>

#include "app/gui/toolkit/words.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr double kSameTime = 1e-6; // [s]

QString secondsWords(double t) {
  return QString::number(t, 'f', 3);
}

// Reports the distance of a rejected pose from the path at its time.
QString wordsOfOutlier(const CameraPose& pose, const CameraTrack& track, const Vec3& tip) {
  const TipMotion motion = motionAt(track, pose.t);
  const double away = (pose.position + pose.orientation * tip - motion.position).norm();
  const double turned = pose.orientation.angularDistance(motion.orientation);
  const double lever = pose.sigma_angle * tip.norm();
  const double sigma = std::sqrt(pose.sigma_position * pose.sigma_position +
                                 2. / 3 * lever * lever + motion.sigma * motion.sigma);
  const double sigma_angle = std::hypot(pose.sigma_angle, motion.sigma_angle);
  return tr("pose at %1 s rejected: %2 and %3° from the filtered path, %4 and %5 sigma")
      .arg(secondsWords(pose.t), inWords(away))
      .arg(turned * 180 / M_PI, 0, 'f', 1)
      .arg(away / sigma, 0, 'f', 0)
      .arg(turned / sigma_angle, 0, 'f', 0);
}

QString wordsOfVerdict(PoseVerdict verdict, double t) {
  return tr("pose at %1 s rejected: %2")
      .arg(secondsWords(t), shownText(std::string(nameOf(verdict))));
}

Finding::Kind kindOf(const SeenFrame& seen) {
  if (!seen.readable) return Finding::Kind::unreadable;
  return seen.verdict == RigVerdict::ambiguous ? Finding::Kind::ambiguous
         : seen.verdict == RigVerdict::misfit  ? Finding::Kind::misfit
                                               : Finding::Kind::no_marker;
}

// Consecutive frames without a pose for the same reason become one finding.
void addFrames(const ScanFiles& files, const std::vector<SeenFrame>& seen,
               std::vector<Finding>& findings) {
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i].looked || seen[i].why.empty()) continue;
    std::size_t last = i;
    // The text of a repeated marker differs from frame to frame.
    const auto isLike = [&](const SeenFrame& other) {
      return other.looked && (other.why == seen[i].why || (other.readable && seen[i].readable &&
                                                           other.verdict == RigVerdict::repeated &&
                                                           other.verdict == seen[i].verdict));
    };
    while (last + 1 < seen.size() && isLike(seen[last + 1])) ++last;
    const double from = files.frames[i].t, to = files.frames[last].t;
    const QString why = shownText(seen[i].why);
    findings.push_back(
        {kindOf(seen[i]), from, to,
         last == i ? tr("frame %1 at %2 s has no pose: %3").arg(i).arg(secondsWords(from), why)
                   : tr("frames %1 to %2, from %3 to %4 s, have no pose: %5")
                         .arg(i)
                         .arg(last)
                         .arg(secondsWords(from), secondsWords(to), why)});
    i = last;
  }
}

double largestSigma(const std::vector<PathSample>& path, const Gap& gap) {
  double max_sigma = 0;
  for (const PathSample& sample : path)
    if (sample.t >= gap.from && sample.t <= gap.to) max_sigma = std::max(max_sigma, sample.sigma);
  return max_sigma;
}

void addGaps(const ScanPath& path, std::vector<Finding>& findings) {
  for (const Gap& gap : path.filtered.without_pose) {
    const double max_sigma = largestSigma(path.filtered.path, gap);
    QString words =
        tr("no pose from %1 to %2 s, for %3 s: the path is interpolated")
            .arg(secondsWords(gap.from), secondsWords(gap.to), secondsWords(gap.to - gap.from));
    if (max_sigma > 0) words += tr(", sigma grows to %1").arg(inWords(max_sigma));
    findings.push_back({Finding::Kind::gap, gap.from, gap.to, words});
  }
  for (const Gap& gap : path.filtered.without_sample)
    findings.push_back(
        {Finding::Kind::dropout, gap.from, gap.to,
         tr("no sample of the probe from %1 to %2 s, for %3 s: the path has a gap")
             .arg(secondsWords(gap.from), secondsWords(gap.to), secondsWords(gap.to - gap.from))});
}

void addRejected(const ScanPath& path, const Vec3& tip, std::vector<Finding>& findings) {
  const CameraTrack& track = path.filtered.track;
  for (std::size_t i = 0; i < track.verdicts.size(); ++i) {
    if (track.verdicts[i] == PoseVerdict::used) continue;
    const double t = path.poses[i].t;
    findings.push_back({Finding::Kind::outlier, t, t,
                        track.verdicts[i] == PoseVerdict::outlier && !track.empty()
                            ? wordsOfOutlier(path.poses[i], track, tip)
                            : wordsOfVerdict(track.verdicts[i], t)});
  }
}

ScanFilter filterFor(const ScanFiles& files) {
  ScanFilter filter = filterOf(files.rig, !files.probe.empty());
  filter.touching_only = false;
  return filter;
}

} // namespace

QString wordOf(Finding::Kind kind) {
  constexpr const char* kWords[] = {"unreadable", "no marker", "ambiguous",     "misfit",
                                    "rejected",   "gap",       "probe dropout", "doubt"};
  return tr(kWords[static_cast<std::size_t>(kind)]);
}

ScanPath pathOf(const ScanFiles& files, const std::vector<CameraPose>& poses,
                const std::vector<SeenFrame>& seen, Progress& progress) {
  ScanPath made;
  made.poses = poses;
  made.probe = files.probe;
  if (!poses.empty()) {
    made.filtered =
        filterStreams({poses, files.probe, files.rates}, files.rig, filterFor(files), progress);
    if (const auto& clock = made.filtered.clock; clock && clock->is_significant)
      for (ProbeSample& sample : made.probe) sample.t = clock->onCamera(sample.t);
  }
  made.path = files.path;
  if (made.path.empty()) {
    const std::vector<PathSample>& all = made.filtered.path;
    std::copy_if(all.begin(), all.end(), std::back_inserter(made.path),
                 [](const PathSample& sample) { return sample.touching; });
    if (made.path.empty()) made.path = all;
  }
  addFrames(files, seen, made.findings);
  for (const std::string& doubt : made.filtered.warnings)
    made.findings.push_back(
        {Finding::Kind::doubt, poses.front().t, poses.front().t, shownText(doubt)});
  addGaps(made, made.findings);
  addRejected(made, files.tip(), made.findings);
  std::stable_sort(made.findings.begin(), made.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.from < b.from; });
  return made;
}

std::optional<std::size_t> poseAt(const std::vector<CameraPose>& poses, double t) {
  const auto after =
      std::lower_bound(poses.begin(), poses.end(), t - kSameTime,
                       [](const CameraPose& pose, double when) { return pose.t < when; });
  if (after == poses.end() || after->t > t + kSameTime) return std::nullopt;
  return static_cast<std::size_t>(after - poses.begin());
}

Pose poseOf(const CameraPose& pose) {
  Pose made = Pose::Identity();
  made.linear() = pose.orientation.toRotationMatrix();
  made.translation() = pose.position;
  return made;
}

FrameQuality qualityOf(const ScanFiles& files, const std::vector<SeenFrame>& seen,
                       const ScanPath* path, std::size_t i) {
  if (path != nullptr) {
    const auto pose = poseAt(path->poses, files.frames[i].t);
    const auto& verdicts = path->filtered.track.verdicts;
    if (pose && *pose < verdicts.size() && verdicts[*pose] != PoseVerdict::used)
      return FrameQuality::rejected;
  }
  if (i >= seen.size() || !seen[i].looked) return FrameQuality::unknown;
  const SeenFrame& frame = seen[i];
  if (!frame.readable) return FrameQuality::unreadable;
  switch (frame.verdict) {
  case RigVerdict::seen:
    return frame.markers > 1 || files.markers.size() == 1 ? FrameQuality::good : FrameQuality::few;
  case RigVerdict::ambiguous:
    return FrameQuality::ambiguous;
  case RigVerdict::misfit:
    return FrameQuality::rejected;
  case RigVerdict::no_marker:
  case RigVerdict::repeated:
    return FrameQuality::no_marker;
  }
  return FrameQuality::unknown;
}

} // namespace patina
