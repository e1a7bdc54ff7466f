#include "demo/demo.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include "acquisition/files/camera_file.h"
#include "acquisition/files/registered_file.h"
#include "acquisition/simulation/simulated_scan.h"
#include "acquisition/simulation/simulated_streams.h"
#include "acquisition/tracking/marker_code.h"
#include "acquisition/tracking/track_frames.h"
#include "core/csv.h"
#include "core/file.h"
#include "demo/true_contact.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/pose_file.h"
#include "geometry/mesh/mesh_unit.h"
#include "haptics/servo/feel.h"
#include "session/edit/editor.h"
#include "workspace/texture_file.h"

namespace patina {
namespace {

const char* const kFamily = "4x4_50";
constexpr double kEnds = 0.05; // of a profile: where it was blended, or the hand was slow
// Harmonics are compared that in the truth are higher than this times the square of their
// wavelength: 10 times what such a scan leaves of noise [1/m].
constexpr double kFloor = 5;
constexpr double kMillimetre = 1e3; // of an .obj in a metre

Pose objectFromCamera(const Demo& demo) {
  return demo.registered.registration.mesh_from_path;
}

// As `patina register --truth` reads it.
std::string truthText(const Demo& demo) {
  return Json::object()
             .set("mesh_from_camera", poseJson(demo.camera_from_object.inverse()))
             .dump() +
         "\n";
}

// Each scan as a folder that every command and the Scan desk open.
void scan(Demo& demo, Progress& progress) {
  std::filesystem::create_directories(demo.folder);
  writeMesh(demo.folder / "toy.obj", demo.in_file);
  const TriangleMesh turned =
      transformed(demo.object.mesh, Eigen::Affine3d(demo.object.plane_from_object.matrix()));
  const Pose camera_from_plane =
      cameraOver(bounds(turned), bounds(turned).sizes().z() / 2 - demo.rig.probe.tip.z());
  demo.camera_from_object = camera_from_plane * demo.object.plane_from_object;
  demo.rig.accelerometers = true;
  demo.rig.gravity = camera_from_plane.linear() * kGravity;
  const std::vector<RigMarker> cube = markerCube(kFamily, markerFamily(kFamily).side, kCubeEdge);
  std::uint32_t seed = demo.seed * 100;
  for (const DemoMaterial& material : demo.object.materials)
    demo.scans.push_back(
        {material.name, handOver(demo.object, material, ++seed), {}, 0, 0, {}, {}});
  demo.scans.push_back({"survey", surveyOf(demo.object, ++seed), {}, 0, 0, {}, {}});
  for (std::size_t i = 0; i < demo.scans.size(); ++i) {
    DemoScan& one = demo.scans[i];
    const std::filesystem::path folder = demo.folder / ("scan-" + one.name);
    FrameCourse course;
    course.camera_from_world = camera_from_plane;
    course.seed = ++seed;
    Progress part(progress, [&](double fraction, std::string_view what) {
      progress.report((static_cast<double>(i) + fraction) / static_cast<double>(demo.scans.size()),
                      what);
    });
    one.frames =
        writeFrames(folder, usualCamera(), one.hand, demo.rig.probe, kFamily, course, part);
    one.streams.samples = simulateProbe(one.hand, demo.rig.probe, {}, ++seed);
    writeProbeStream(folder / "probe.csv", one.streams.samples);
    writeFileAtomically(folder / "rig.json", rigText(demo.rig, cube));
    writeFileAtomically(folder / "truth.json", truthText(demo));
    std::vector<double> times;
    for (const ProbeSample& sample : one.streams.samples) times.push_back(sample.t);
    writePath(folder / "truth.csv", truthAt(one.hand, camera_from_plane, times));
  }
}

Pose cameraFromPlane(const Demo& demo) {
  return demo.camera_from_object * demo.object.plane_from_object.inverse();
}

void trackOne(const Demo& demo, DemoScan& one, Progress& progress) {
  const std::filesystem::path folder = demo.folder / ("scan-" + one.name);
  const auto frames = openFrames(folder.string(), 0);
  const TrackedFrames found = trackFrames(*frames, readCamera(folder / "camera.yml"),
                                          readMarkers(folder / "rig.json"), {}, progress);
  progress.throwIfCancelled();
  if (found.poses.empty()) throw Error(one.name + ": no frame shows a pose of the markers");
  writePoses(folder / "poses.tum", found.poses, found.without);
  // As any command reads them.
  one.streams.poses = readPoses(folder / "poses.tum").values;
  one.streams.samples = readProbeStream(folder / "probe.csv").values;
  double squares = 0;
  for (const CameraPose& pose : found.poses) {
    const Vec3 tip = pose.position + pose.orientation * demo.rig.probe.tip;
    squares += (tip - cameraFromPlane(demo) * handAt(one.hand, pose.t).tip).squaredNorm();
  }
  one.tip_error = std::sqrt(squares / static_cast<double>(found.poses.size()));
}

void track(Demo& demo, Progress& progress) {
  std::vector<std::atomic<double>> done(demo.scans.size());
  tbb::parallel_for(std::size_t{0}, demo.scans.size(), [&](std::size_t i) {
    Progress part(progress, [&](double fraction, std::string_view what) {
      done[i] = fraction;
      progress.report(
          std::accumulate(done.begin(), done.end(), 0.) / static_cast<double>(done.size()), what);
    });
    trackOne(demo, demo.scans[i], part);
  });
}

void filter(Demo& demo, Progress& progress) {
  for (DemoScan& one : demo.scans) {
    one.filtered = touchedPath(one.streams, demo.rig, progress);
    std::vector<double> times;
    for (const PathSample& sample : one.filtered.path) times.push_back(sample.t);
    one.path_error = errorOf(one.filtered.path, truthAt(one.hand, cameraFromPlane(demo), times));
    writePath(demo.folder / ("path-" + one.name + ".csv"), one.filtered.path);
  }
}

void registerAll(Demo& demo, Progress& progress) {
  std::vector<std::vector<PathSample>> paths;
  for (const DemoScan& one : demo.scans) paths.push_back(one.filtered.path);
  demo.registered = registerScans(demo.target, paths, {}, progress);
  if (!demo.registered.registration.converged)
    throw Error("no pose was found at which the paths lie on the mesh");
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < demo.scans.size(); ++i) {
    const std::vector<PathSample>& path = demo.registered.paths[i];
    writeRegisteredPath(demo.folder / ("registered-" + demo.scans[i].name + ".csv"), path,
                        demo.registered.of(i));
    for (const PathSample& sample : path) {
      squares += (objectFromCamera(demo) * sample.position -
                  demo.camera_from_object.inverse() * sample.position)
                     .squaredNorm();
      count += 1;
    }
  }
  demo.registration_error = std::sqrt(squares / count);
}

// Heights over the true ground along the line that the hand was to follow, by their true way over
// it: nothing that was measured has a part in it.
std::vector<ProfilePoint> trueProfile(const DemoObject& object, const DemoMaterial& material) {
  constexpr double kStep = 0.05e-3; // [m]
  const double length = (material.to - material.from).norm();
  const Vec2 heading = (material.to - material.from) / length;
  std::vector<ProfilePoint> profile;
  double way = 0, last = 0;
  for (double s = 0; s <= length; s += kStep) {
    const Vec2 place = material.from + s * heading;
    const double ground = object.ground(place);
    if (s > 0) way += std::hypot(kStep, ground - last);
    last = ground;
    profile.push_back({way, material.height(place) * object.normal(place).z(), 0});
  }
  return profile;
}

void fit(Demo& demo, Progress&) {
  for (std::size_t i = 0; i < demo.object.materials.size(); ++i) {
    const DemoScan& one = demo.scans[i];
    demo.textures.emplace_back();
    DemoTexture& texture = demo.textures.back();
    texture.scanned = fitScanTexture(demo.target, one.filtered, one.streams.poses, demo.rig,
                                     demo.registered.paths[i], demo.registered.of(i));
    FourierTexture& fitted = texture.scanned.fitted.texture;
    fitted.name = "scan-" + one.name; // as its folder
    writeHeights(demo.folder / ("heights-" + one.name + ".csv"), texture.scanned.heights);
    writeTexture(demo.folder / (one.name + ".json"), fitted);
    texture.spectrum = spectrumError(fitted, trueProfile(demo.object, demo.object.materials[i]),
                                     *scanFitOptions().cutoff, kFloor);
  }
}

void map(Demo& demo, Progress& progress) {
  LayOptions options;
  std::vector<TexturedFace> faces;
  for (std::size_t i = 0; i < demo.textures.size(); ++i) {
    ScannedTexture& scanned = demo.textures[i].scanned;
    options.texture = static_cast<std::int32_t>(i + 1);
    scanned.laid = layScanTexture(demo.object.mesh, scanned.strokes, options, progress);
    faces = laidOver(scanned.laid.faces, faces);
  }
  writeTexturedMesh(demo.folder / "textured.obj", demo.in_file, faces, 1 / kMillimetre);
}

// Along the way that was scanned, coloured; friction where nothing was scanned.
std::vector<Stroke> paintStrokes(const Demo& demo) {
  std::vector<Stroke> strokes;
  for (std::size_t i = 0; i < demo.textures.size(); ++i) {
    Stroke stroke;
    const Vec3& color = demo.object.materials[i].color;
    stroke.brush.color = {color.x(), color.y(), color.z()};
    stroke.brush.radius = 6e-3;
    stroke.brush.falloff = 4;
    for (const PathOnMesh& part : demo.textures[i].scanned.strokes)
      for (std::size_t k = 0; k < part.points.size(); k += 4)
        stroke.samples.push_back(
            {static_cast<double>(stroke.samples.size()) * 8e-3, part.points[k], 1, {}});
    strokes.push_back(std::move(stroke));
  }
  const Pose object_from_plane = demo.object.plane_from_object.inverse();
  Stroke grip;
  grip.brush.color = {0.2, 0.2, 0.22};
  grip.brush.radius = 7e-3;
  grip.brush.falloff = 4;
  grip.brush.also = {{Tool::material(MaterialChannel::static_friction), {}, 0.8},
                     {Tool::material(MaterialChannel::dynamic_friction), {}, 0.6}};
  for (int k = 0; k <= 40; ++k)
    grip.samples.push_back({k * 8e-3, object_from_plane * demo.object.grip(k / 40.), 1, {}});
  strokes.push_back(std::move(grip));
  return strokes;
}

void paint(Demo& demo, Progress& progress) {
  std::vector<ScannedTexture> textures;
  for (const DemoTexture& texture : demo.textures) textures.push_back(texture.scanned);
  Editor editor(texturedScene(demo.object.mesh, demo.object.name, textures), progress);
  for (const Stroke& stroke : paintStrokes(demo)) editor.apply(stroke, progress);
  editor.saveAs(demo.folder / "workspace");
  demo.compiled = editor.compiled();
}

constexpr double kDepth = 0.5e-3; // below the mesh, of the tip that feels [m]
constexpr double kStep = 0.04e-3; // it goes a tick [m]
constexpr double kAside = 0.8e-3; // the nearest point of the true surface is not farther aside [m]
constexpr int kLandingTicks = 100;

// A tip that comes down, yields to half its depth and back, and goes along the stroke.
void feelOne(Demo& demo, std::size_t i, Progress& progress) {
  const DemoMaterial& material = demo.object.materials[i];
  const auto& ground = demo.object.ground;
  const SimulatedHand& hand = demo.scans[i].hand;
  const Pose object_from_plane = demo.object.plane_from_object.inverse();
  const double length = (material.to - material.from).norm();
  const Vec2 heading = (material.to - material.from) / length;
  const auto placeAt = [&](double s) { return Vec2(material.from + s * heading); };
  const auto above = [&](double s, double height) -> Vec3 {
    const Vec2 place = placeAt(s);
    return Vec3(place.x(), place.y(), ground(place)) + height * hand.normal(place);
  };
  // Where the ends were blended, and the hand was slow, nothing is claimed.
  const double begin = 0.08 * length, end = (1 - kEnds - 0.02) * length;
  std::vector<TimedTip> tips;
  std::vector<Vec3> in_plane;
  const auto add = [&](const Vec3& tip) {
    in_plane.push_back(tip);
    tips.push_back({1e-3 * static_cast<double>(tips.size()), object_from_plane * tip});
  };
  for (int k = 0; k < kLandingTicks; ++k)
    add(above(begin, 1e-3 - (1e-3 + kDepth) * k / kLandingTicks));
  const std::size_t deep = tips.size();
  for (int k = 0; k <= kLandingTicks; ++k)
    add(above(begin, -kDepth * (1 - 0.5 * k / kLandingTicks)));
  const std::size_t shallow = tips.size() - 1;
  for (int k = 0; k <= kLandingTicks; ++k)
    add(above(begin, -kDepth * (0.5 + 0.5 * k / kLandingTicks)));
  const std::size_t first = tips.size();
  for (double s = begin; s < end; s += kStep) add(above(s, -kDepth));
  CsvTable path{{"t [s]", "x [m]", "y [m]", "z [m]"}, {}};
  for (const TimedTip& tip : tips)
    path.rows.push_back({tip.t, tip.tip.x(), tip.tip.y(), tip.tip.z()});
  writeCsv(demo.folder / ("tip-" + material.name + ".csv"), path);
  const std::vector<ToolSample> samples = feel(*demo.compiled->snapshot, tips, progress);

  DemoTexture& texture = demo.textures[i];
  const Vec3 outward = hand.normal(placeAt(begin));
  const auto felt = [&](std::size_t k) -> Vec3 {
    return demo.object.plane_from_object.linear() * samples[k].force;
  };
  texture.stiffness = (felt(deep) - felt(shallow)).dot(outward) / (0.5 * kDepth);
  const HeightOver surface = [&](const Vec2& place) {
    return ground(place) + material.height(place);
  };
  CsvTable rows{{"along [m]", "felt [N]", "true [N]"}, {}};
  double along = 0;
  for (std::size_t k = first; k < tips.size(); ++k) {
    if (k % 256 == 0) progress.throwIfCancelled();
    if (k > first) along += (in_plane[k] - in_plane[k - 1]).norm();
    FeltPoint point;
    point.along = along;
    point.outward = hand.normal(in_plane[k].head<2>());
    point.felt = felt(k);
    point.truth = trueForce(surface, in_plane[k], material.stiffness, kAside);
    rows.rows.push_back({along, point.felt.dot(point.outward), point.truth.dot(point.outward)});
    texture.felt.push_back(point);
  }
  texture.felt_error = feltError(texture.felt);
  writeCsv(demo.folder / ("felt-" + material.name + ".csv"), rows);
}

void feelAll(Demo& demo, Progress& progress) {
  for (std::size_t i = 0; i < demo.textures.size(); ++i) {
    progress.report(static_cast<double>(i) / static_cast<double>(demo.textures.size()), "forces");
    feelOne(demo, i, progress);
  }
}

} // namespace

namespace {

// The mesh as its file has it, and as every command reads that: to the last bit.
const TriangleMesh& throughFile(TriangleMesh& in_file, TriangleMesh& mesh) {
  for (Vec3& p : in_file.positions) p *= kMillimetre;
  return mesh = inMetres(in_file, MeshUnit::mm).mesh;
}

} // namespace

Demo::Demo(std::filesystem::path where, std::uint32_t chosen, DemoObject scanned)
    : folder(std::move(where)), seed(chosen), object(std::move(scanned)), in_file(object.mesh),
      target(throughFile(in_file, object.mesh), 0, true) {}

const std::vector<DemoStep>& demoSteps() {
  static const std::vector<DemoStep> kSteps = {
      {"scan", "A hand scans three materials and surveys the toy; a camera films its probe.", scan},
      {"track", "Markers in the frames become poses of the probe.", track},
      {"filter", "Poses and accelerations become the tip's path.", filter},
      {"register", "The paths find their place on the mesh.", registerAll},
      {"fit", "Accelerations become heights, heights become harmonics.", fit},
      {"map", "Each texture is laid onto the faces that its stroke ran over.", map},
      {"paint", "Colour and friction are painted beside what was scanned.", paint},
      {"feel", "A tip feels the result, and the true surface beside it.", feelAll}};
  return kSteps;
}

void runNext(Demo& demo, Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  demoSteps().at(demo.seconds.size()).run(demo, progress);
  demo.seconds.push_back(
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

bool isDone(const Demo& demo) {
  return demo.seconds.size() == demoSteps().size();
}

} // namespace patina
