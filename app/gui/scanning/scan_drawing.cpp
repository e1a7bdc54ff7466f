#include "app/gui/scanning/scan_drawing.h"

#include <cmath>

#include "app/gui/toolkit/words.h"

namespace patina {
namespace {

constexpr double kMaxPause = 0.05; // Longest time between samples of one stroke [s].

double valueOf(const PathSample& sample, PathColor color) {
  switch (color) {
  case PathColor::force:
    return sample.force;
  case PathColor::sigma:
    return 1e3 * sample.sigma;
  case PathColor::time:
    return sample.t;
  }
  return 0;
}

} // namespace

QString captionOf(PathColor color) {
  constexpr const char* kCaptions[] = {"force [N]", "sigma [mm]", "time [s]"};
  return tr(kCaptions[static_cast<std::size_t>(color)]);
}

Pose pictureFromCamera(const ScanFiles& files) {
  return files.mesh_from_camera.value_or(Pose::Identity());
}

Vec3 upOf(const ScanFiles& files) {
  if (files.mesh_from_camera) return Vec3::UnitZ();
  const bool known = files.rig && files.rig->accelerometers;
  return known ? Vec3(-files.rig->gravity.normalized()) : Vec3(-Vec3::UnitY());
}

DrawnPath drawnPath(const ScanFiles& files, const ScanPath& path, PathColor color) {
  DrawnPath drawn;
  drawn.title = captionOf(color).toStdString();
  const Pose frame = pictureFromCamera(files);
  const std::vector<Gap>& gaps = path.filtered.without_pose;
  auto gap = gaps.begin();
  double last = -INFINITY;
  // Samples without a probe are as far apart as the frames.
  const double pause = files.probe.empty() ? path.filtered.track.options.longest_gap : kMaxPause;
  for (const PathSample& sample : path.path) {
    while (gap != gaps.end() && gap->to < sample.t) ++gap;
    const bool in_gap = gap != gaps.end() && sample.t > gap->from && sample.t < gap->to;
    drawn.samples.push_back({sample.t, frame * sample.position, valueOf(sample, color),
                             sample.gap || in_gap, sample.t - last > pause});
    last = sample.t;
  }
  return drawn;
}

std::vector<DrawnMark> drawnMarks(const ScanFiles& files, const ScanPath& path) {
  std::vector<DrawnMark> marks;
  const Pose frame = pictureFromCamera(files);
  const auto& verdicts = path.filtered.track.verdicts;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    const CameraPose& pose = path.poses[i];
    if (verdicts[i] == PoseVerdict::outlier)
      marks.push_back({pose.t, frame * (poseOf(pose) * files.tip())});
  }
  return marks;
}

DrawnCamera drawnCamera(const ScanFiles& files) {
  DrawnCamera drawn;
  drawn.picture_from_camera = pictureFromCamera(files);
  if (files.camera) {
    drawn.wide = files.camera->width / files.camera->fx;
    drawn.high = files.camera->height / files.camera->fy;
  }
  return drawn;
}

} // namespace patina
