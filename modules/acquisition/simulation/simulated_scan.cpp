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
  Eigen::Matrix3d axes; // of the camera: x right, y down, z forward
  axes.col(2) = (middle - eye).normalized();
  axes.col(0) = axes.col(2).cross(Vec3::UnitZ()).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  Pose plane_from_camera = Pose::Identity();
  plane_from_camera.linear() = axes;
  plane_from_camera.translation() = eye;
  return plane_from_camera.inverse();
}

std::size_t writeFrames(const std::filesystem::path& folder, const Camera& camera,
                        const SimulatedHand& hand, const ProbeModel& probe,
                        const std::string& family, const FrameCourse& course, Progress& progress) {
  const MarkerFamily& markers = markerFamily(family);
  std::vector<PrintedMarker> printed;
  for (const RigMarker& marker : markerCube(family, markers.side, kCubeEdge))
    printed.push_back({marker, markers.side, markers.code[static_cast<std::size_t>(marker.id)]});
  const FrameRenderer renderer(camera, printed);
  CsvTable times{{"frame", "t [s]"}, {}};
  const int count = frameCount(hand, course);
  makeFolder(folder / "frames");
  std::atomic<int> done{0};
  tbb::parallel_for(0, count, [&](int i) {
    progress.throwIfCancelled();
    progress.report(static_cast<double>(done++) / count, "frames");
    char name[32];
    std::snprintf(name, sizeof name, "frames/%06d.png", i);
    writeGrey(folder / name, frameAt(renderer, hand, probe, course, i));
  });
  for (int i = 0; i < count; ++i) times.rows.push_back({static_cast<double>(i), i / course.rate});
  writeCsv(folder / "frames.csv", times);
  writeFileAtomically(folder / "camera.yml", cameraText(camera));
  return static_cast<std::size_t>(count);
}

} // namespace patina
