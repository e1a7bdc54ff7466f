#include "scan/scan_texture.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/numbers.h"
#include "geometry/io/textured_obj.h"
#include "geometry/mesh/mesh_report.h"
#include "session/open/session.h"

namespace patina {
namespace {

constexpr double kShape = 8e-3; // longer waves belong to the body's shape [m]
// fraction of the mesh's size; strokes farther off have another unit
constexpr double kFarOfSize = 0.05;

} // namespace

FitOptions1d scanFitOptions() {
  FitOptions1d options;
  options.cutoff = kShape;
  return options;
}

ScanHeights heightsOverMesh(const SurfaceTarget& target, const FilteredScan& scan,
                            const std::vector<CameraPose>& poses, const Rig& rig,
                            const Pose& mesh_from_scan, const std::optional<double>& compliance) {
  if (scan.whole.empty())
    throw Error("rig.json names no accelerometers, which are needed for heights");
  const auto presses = complianceOverMesh(target, mesh_from_scan, scan.path);
  const double yields = presses && presses->isSignificant() ? presses->compliance : 0;
  ScanHeights found =
      scanHeights(scan, poses, rig.probe, rig.gravity,
                  meanNormal(target, mesh_from_scan, scan.path), compliance.value_or(yields));
  found.compliance = presses;
  found.heights = heightsOverMesh(target, mesh_from_scan, scan.path, found);
  if (found.heights.empty()) throw Error("there is no height over the mesh along the path");
  return found;
}

ScanHeights heightsOverPlane(const FilteredScan& scan, const std::vector<CameraPose>& poses,
                             const Rig& rig, const std::optional<Vec3>& normal) {
  return scanHeights(scan, poses, rig.probe, rig.gravity, normal);
}

std::vector<ProfilePoint> profileOf(const std::vector<ScanHeight>& heights) {
  std::vector<ScanHeight> longest;
  const auto length = [](auto begin, auto end) {
    return (end - 1)->point.arc_length - begin->point.arc_length;
  };
  for (auto begin = heights.begin(); begin != heights.end();) {
    const auto end = std::find_if(begin, heights.end(), [&](const ScanHeight& height) {
      return height.stretch != begin->stretch;
    });
    if (longest.empty() || length(begin, end) > length(longest.begin(), longest.end()))
      longest.assign(begin, end);
    begin = end;
  }
  std::vector<ProfilePoint> profile;
  for (const ScanHeight& height : longest) profile.push_back(height.point);
  return profile;
}

ScanPlace scanPlace(const std::vector<PathSample>& path, const Registration& registration) {
  ScanPlace place;
  place.mesh_from_scan = registration.mesh_from_path;
  if (!registration.compliances.empty()) place.compliance = registration.compliances.front();
  for (std::size_t i = 0; i < path.size(); ++i)
    if (registration.inliers[i])
      place.points.push_back({path[i].t, registration.mesh_from_path * path[i].position});
  return place;
}

ScannedTexture fitScanTexture(const SurfaceTarget& target, const FilteredScan& scan,
                              const std::vector<CameraPose>& poses, const Rig& rig,
                              const ScanPlace& place, const FitOptions1d& options) {
  std::optional<double> compliance = place.compliance;
  const ScanHeights over =
      heightsOverMesh(target, scan, poses, rig, place.mesh_from_scan, compliance);
  if (!compliance && over.compliance && over.compliance->isSignificant())
    compliance = over.compliance->compliance;
  ScannedTexture found;
  found.heights = over.heights;
  found.strokes = strokesOf(place.points, intervalPositions(found.heights));
  found.fitted = fitTexture(profileOf(found.heights), options);
  if (compliance && *compliance > 0) found.fitted.texture.compliance = compliance;
  return found;
}

MappedTexture layScanTexture(const TriangleMesh& mesh, const std::vector<PathOnMesh>& strokes,
                             const LayOptions& options, const Progress& progress) {
  const std::vector<std::int32_t> usable = usableTriangles(mesh);
  if (usable.empty()) throw Error("the mesh has no face that can take a texture");
  TriangleMesh on;
  on.positions = mesh.positions;
  for (const std::int32_t face : usable)
    on.triangles.push_back(mesh.triangles[static_cast<std::size_t>(face)]);
  const MeshQuery ground(std::move(on));
  MappedTexture laid = mapTexture(ground, strokes, options, progress);
  const double size = bounds(ground.mesh).sizes().norm();
  if (laid.max_distance > kFarOfSize * size)
    throw Error("lies up to " + formatLength(laid.max_distance) + " from a mesh of " +
                formatLength(size) + "; is it registered, and --unit right?");
  if (laid.faces.empty()) throw Error("no face under the path can take texture coordinates");
  for (TexturedFace& face : laid.faces) face.face = usable[static_cast<std::size_t>(face.face)];
  return laid;
}

void writeTexturedMesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                       std::vector<TexturedFace> faces, double scale) {
  for (TexturedFace& face : faces)
    for (Vec2& at : face.coords) at /= scale;
  writeTexturedObj(path, mesh, faces);
}

Scene texturedScene(TriangleMesh mesh, const std::string& name,
                    const std::vector<ScannedTexture>& textures) {
  Scene scene = sceneOf(std::move(mesh), name);
  TextureMappings laid;
  double stiffness = 0, known = 0;
  for (const ScannedTexture& scanned : textures) {
    const auto number = static_cast<std::int32_t>(laid.library.size() + 1);
    std::vector<TexturedFace> faces = scanned.laid.faces;
    for (TexturedFace& face : faces) face.texture = number;
    laid.faces = laidOver(faces, laid.faces);
    laid.library[number] = hapticTexture(scanned.fitted.texture);
    stiffness += laid.library[number]->stiffness;
    known += laid.library[number]->stiffness > 0;
  }
  if (known > 0) scene.haptics.stiffness = std::round(stiffness / known);
  ObjectPaint paint;
  paint.textures = std::make_shared<const TextureMappings>(std::move(laid));
  scene.objects[0].paint = std::make_shared<const ObjectPaint>(std::move(paint));
  return scene;
}

} // namespace patina
