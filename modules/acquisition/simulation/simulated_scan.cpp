#include "acquisition/simulation/simulated_scan.h"

#include <atomic>
#include <cstdio>

#include <tbb/parallel_for.h>

#include "acquisition/files/camera_file.h"
#include "acquisition/files/frame_files.h"
#include "acquisition/tracking/marker_code.h"
#include "core/csv.h"
#include "core/file.h"

namespace patina {

Camera usualCamera() {
  return {640, 480, 600, 600, 321.5, 238.5, {-0.08, 0.03, 3e-4, -2e-4, 0}};
}

Pose cameraOver(const Box3& box, double over) {
  const Vec3 middle = box.center() + over * Vec3::UnitZ(),
             eye = middle + 0.4 * Vec3(0, -0.5, 0.8).normalized();
  Eigen::Matrix3d axes; // camera axes: x right, y down, z forward
  axes.col(2) = (middle - eye).normalized();
  axes.col(0) = axes.col(2).cross(Vec3::UnitZ()).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  Pose plane_from_camera = Pose::Identity();
  plane_from_camera.linear() = axes;
  plane_from_camera.translation() = eye;
  return plane_from_camera.inverse();
}

std::size_t writeFrames(const std::filesystem::path& folder, const Camera& camera,
                        const ProbeMotion& camera_from_probe, double seconds,
                        const std::vector<RigMarker>& markers, const CaptureSettings& course,
                        Progress& progress) {
  std::vector<PrintedMarker> printed;
  for (const RigMarker& marker : markers) {
    const MarkerFamily& family = markerFamily(marker.family);
    printed.push_back({marker, family.side, family.code[static_cast<std::size_t>(marker.id)]});
  }
  const FrameRenderer renderer(camera, printed);
  CsvTable times{{"frame", "t [s]"}, {}};
  const auto count = static_cast<int>(seconds * course.rate);
  makeFolder(folder / "frames");
  std::atomic<int> done{0};
  tbb::parallel_for(0, count, [&](int i) {
    progress.throwIfCancelled();
    progress.report(static_cast<double>(done++) / count, "frames");
    char name[32];
    std::snprintf(name, sizeof name, "frames/%06d.png", i);
    writeGrey(folder / name, frameAt(renderer, camera_from_probe, course, i));
  });
  for (int i = 0; i < count; ++i) times.rows.push_back({static_cast<double>(i), i / course.rate});
  writeCsv(folder / "frames.csv", times);
  writeFileAtomically(folder / "camera.yml", cameraText(camera));
  return static_cast<std::size_t>(count);
}

} // namespace patina
