#include "scan/scan_steps.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "session/build/session.h"

namespace patina {
namespace {

// Heights of the stretch that goes farthest.
std::vector<ScanHeight> longestStroke(const std::vector<ScanHeight>& heights) {
  std::vector<ScanHeight> longest;
  for (auto begin = heights.begin(); begin != heights.end();) {
    const auto end = std::find_if(begin, heights.end(), [&](const ScanHeight& height) {
      return height.stretch != begin->stretch;
    });
    if (longest.empty() || (end - 1)->point.along > longest.back().point.along)
      longest.assign(begin, end);
    begin = end;
  }
  return longest;
}

PathOnMesh strokeUnder(const std::vector<ScanHeight>& heights, const std::vector<PathSample>& path,
                       const Pose& mesh_from_scan) {
  PathOnMesh stroke;
  auto sample = path.begin();
  for (const ScanHeight& height : heights) {
    while (sample->t < height.t) ++sample;
    // Where the probe stood there is no way.
    if (!stroke.along.empty() && !(height.point.along > stroke.along.back())) continue;
    stroke.points.push_back(mesh_from_scan * sample->position);
    stroke.along.push_back(height.point.along);
  }
  return stroke;
}

} // namespace

FilteredScan touchedPath(const ScanStreams& streams, const ProbeModel& probe, const Vec3& gravity,
                         Progress& progress) {
  ScanFilter filter;
  filter.gravity = gravity;
  FilteredScan scan = filterScan(streams.poses, streams.samples, probe, filter, progress);
  if (scan.path.empty()) throw Error("the probe never touches");
  return scan;
}

ScannedTexture fitScan(const SurfaceTarget& target, const FilteredScan& scan,
                       const std::vector<CameraPose>& poses, const ProbeModel& probe,
                       const Vec3& gravity, const Pose& mesh_from_scan, double compliance,
                       const FitOptions1d& options) {
  const ScanHeights heights = scanHeights(
      scan, poses, probe, gravity, meanNormal(target, mesh_from_scan, scan.path), compliance);
  ScannedTexture found;
  found.heights = longestStroke(heightsOverMesh(target, mesh_from_scan, scan.path, heights));
  if (found.heights.empty()) throw Error("nowhere along the path is there a height over the mesh");
  found.stroke = strokeUnder(found.heights, scan.path, mesh_from_scan);
  std::vector<ProfilePoint> profile;
  for (const ScanHeight& height : found.heights) profile.push_back(height.point);
  found.fitted = fitTexture(profile, options);
  if (compliance > 0) found.fitted.texture.compliance = compliance;
  return found;
}

Scene texturedScene(TriangleMesh mesh, const std::string& name,
                    const std::vector<ScannedTexture>& textures) {
  Scene scene = sceneOf(std::move(mesh), name);
  LaidTextures laid;
  double stiffness = 0, known = 0;
  for (const ScannedTexture& scanned : textures) {
    const auto number = static_cast<std::int32_t>(laid.library.size() + 1);
    std::vector<TexturedFace> faces = scanned.laid.faces;
    for (TexturedFace& face : faces) face.texture = number;
    laid.faces = laidOver(faces, laid.faces);
    laid.library[number] = feltTexture(scanned.fitted.texture);
    stiffness += laid.library[number]->stiffness;
    known += laid.library[number]->stiffness > 0;
  }
  if (known > 0) scene.haptics.stiffness = std::round(stiffness / known);
  ObjectPaint paint;
  paint.textures = std::make_shared<const LaidTextures>(std::move(laid));
  scene.objects[0].paint = std::make_shared<const ObjectPaint>(std::move(paint));
  return scene;
}

} // namespace patina
