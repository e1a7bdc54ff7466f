#include "demo/demo.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include <tbb/parallel_for.h>

#include "acquisition/files/camera_file.h"
#include "acquisition/files/registered_file.h"
#include "acquisition/printing/printed_rig.h"
#include "acquisition/simulation/simulated_scan.h"
#include "acquisition/simulation/simulated_streams.h"
#include "core/csv.h"
#include "core/decompose.h"
#include "core/error.h"
#include "core/file.h"
#include "demo/truth_errors.h"
#include "field/surface/models.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/pose_file.h"
#include "geometry/mesh/mesh_unit.h"
#include "geometry/tree/triangle_tree.h"
#include "haptics/servo/feel.h"
#include "scan/track_scan.h"
#include "session/edit/editor.h"
#include "workspace/texture_file.h"

namespace patina {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kSpeed = 0.06; // mean speed of a stroke [m/s]

Vec2 along(const DemoMaterial& material) {
  return (material.to - material.from).normalized();
}

// Rounded ridges across the stroke.
DemoMaterial ribs(const DemoStroke& way) {
  DemoMaterial ribs{"ribs", {}, 3000, way.from, way.to, 5e-3, 120e-6, {0.83, 0.42, 0.27}};
  ribs.height = [middle = ribs.from, heading = along(ribs)](const Vec2& place) {
    const double x = kTwoPi * heading.dot(place - middle) / 5e-3;
    return 120e-6 * std::cos(x) + 40e-6 * std::cos(2 * x + 1);
  };
  return ribs;
}

// Threads along and across the stroke.
DemoMaterial weave(const DemoStroke& way) {
  DemoMaterial weave{"weave", {}, 2000, way.from, way.to, 3e-3, 80e-6, {0.36, 0.56, 0.71}};
  weave.height = [middle = weave.from, heading = along(weave)](const Vec2& place) {
    const Vec2 at = place - middle;
    const double x = heading.dot(at), y = heading.x() * at.y() - heading.y() * at.x();
    return 80e-6 * std::cos(kTwoPi * x / 3e-3) + 30e-6 * std::cos(kTwoPi * y / 3e-3) +
           30e-6 * std::cos(kTwoPi * x / 2e-3 + 2);
  };
  return weave;
}

// Waves of many lengths, roughly across the stroke.
DemoMaterial grain(const DemoStroke& way) {
  DemoMaterial grain{"grain", {}, 2500, way.from, way.to, 4e-3, 80e-6, {0.55, 0.62, 0.34}};
  grain.height = [middle = grain.from, heading = along(grain)](const Vec2& place) {
    struct Wave {
      double length, turned, height, phase;
    };
    constexpr Wave kWaves[] = {{4e-3, 0, 80e-6, 0},       {3.1e-3, 0.3, 45e-6, 1},
                               {2.3e-3, -0.25, 32e-6, 4}, {5.7e-3, 0.15, 30e-6, 2.5},
                               {1.7e-3, 0.1, 20e-6, 5},   {2.7e-3, -0.4, 25e-6, 3}};
    const Vec2 at = place - middle;
    double height = 0;
    for (const Wave& wave : kWaves) {
      const Vec2 across = Eigen::Rotation2Dd(wave.turned) * heading;
      height += wave.height * std::cos(kTwoPi * across.dot(at) / wave.length + wave.phase);
    }
    return height;
  };
  return grain;
}

// Heights of the mesh on a grid, smoothed by a cubic B-spline, which moves them by some
// micrometres.
class SmoothHeights {
 public:
  explicit SmoothHeights(const TriangleMesh& mesh) : box_(bounds(mesh)) {
    const TriangleTree tree(mesh);
    const double top = box_.max().z() + 1e-3, deep = box_.sizes().z() + 2e-3;
    for (int k = 0; k < 2; ++k) size_[k] = static_cast<int>(box_.sizes()[k] / kGrid) + 4;
    for (int j = 0; j < size_[1]; ++j)
      for (int i = 0; i < size_[0]; ++i) {
        const Vec2 place = box_.min().head<2>() + kGrid * Vec2(i - 1, j - 1);
        const auto hit = tree.firstHit({place.x(), place.y(), top}, -Vec3::UnitZ(), deep);
        heights_.push_back(hit ? top - hit->t : std::numeric_limits<double>::quiet_NaN());
      }
  }

  double at(const Vec2& place) const {
    const Vec2 cell = (place - box_.min().head<2>()) / kGrid + Vec2::Ones();
    const int i = static_cast<int>(cell.x()), j = static_cast<int>(cell.y());
    if (!(cell.minCoeff() >= 1 && i + 2 < size_[0] && j + 2 < size_[1]))
      throw Error("a stroke leaves the surface");
    const std::array<double, 4> x = weights(cell.x() - i), y = weights(cell.y() - j);
    double height = 0;
    for (int b = 0; b < 4; ++b)
      for (int a = 0; a < 4; ++a)
        height += x[index(a)] * y[index(b)] * heights_[index((j + b - 1) * size_[0] + i + a - 1)];
    if (!std::isfinite(height)) throw Error("a stroke leaves the surface");
    return height;
  }

 private:
  static constexpr double kGrid = 0.75e-3; // [m]

  static std::array<double, 4> weights(double u) {
    const double v = 1 - u;
    return {v * v * v / 6, (4 - 6 * u * u + 3 * u * u * u) / 6, (4 - 6 * v * v + 3 * v * v * v) / 6,
            u * u * u / 6};
  }

  Box3 box_;
  int size_[2] = {};
  std::vector<double> heights_;
};

constexpr double kLook = 0.5e-3; // edge length of the faces [m]

std::function<Vec3(const Vec2&)> normalOf(const std::function<double(const Vec2&)>& ground) {
  return [ground](const Vec2& place) -> Vec3 {
    const auto slope = [&](const Vec2& aside) {
      return (ground(place + aside) - ground(place - aside)) / (2 * kLook);
    };
    return Vec3(-slope({kLook, 0}), -slope({0, kLook}), 1).normalized();
  };
}

void press(SimulatedHand& hand, const Vec2& place) {
  for (int i = 0; i < 8; ++i) {
    hand.moves.push_back({place, 0.7, 0, 5.0, 0});
    hand.moves.push_back({place, 0.3, 0, 0.6, 0});
  }
}

} // namespace

DemoObject demoObject() {
  TriangleMesh mesh = dinosaur();
  for (Vec3& p : mesh.positions) p *= 2;
  const Pose side(rotationFromTo(-Vec3::UnitY(), Vec3::UnitZ()));
  DemoStrokes ways; // [m]
  ways.ribs = {{-0.078, -0.037}, {-0.030, -0.022}};
  ways.weave = {{0.036, -0.049}, {0.039, 0.002}};
  ways.grain = {{0.051, 0.011}, {0.075, 0.047}};
  ways.grip = {{-0.006, -0.010}, {0.020, -0.006}};
  ways.survey = {{-0.005, -0.046}, {-0.004, -0.008}, {0.008, 0.003},  {0.012, -0.015},
                 {0.032, -0.006},  {0.038, -0.040},  {0.040, -0.006}, {0.050, 0.010},
                 {0.064, 0.038},   {0.086, 0.043},   {0.070, 0.047}};
  return demoObjectOf("dinosaur", std::move(mesh), side, ways);
}

DemoObject demoObjectOf(const std::string& name, TriangleMesh mesh, const Pose& plane_from_object,
                        const DemoStrokes& ways) {
  if (ways.survey.empty()) throw std::invalid_argument("demoObjectOf: no survey");
  DemoObject object;
  object.name = name;
  object.mesh = std::move(mesh);
  object.plane_from_object = plane_from_object;
  object.materials = {ribs(ways.ribs), weave(ways.weave), grain(ways.grain)};
  object.survey = ways.survey;
  const TriangleMesh turned =
      transformed(object.mesh, Eigen::Affine3d(object.plane_from_object.matrix()));
  object.ground = [heights = std::make_shared<const SmoothHeights>(turned)](const Vec2& place) {
    return heights->at(place);
  };
  for (const auto& way : {ways.ribs, ways.weave, ways.grain, ways.grip})
    for (const Vec2& end : {way.from, way.to}) object.ground(end);
  for (const Vec2& place : ways.survey) object.ground(place);
  object.normal = normalOf(object.ground);
  object.grip = [ground = object.ground, way = ways.grip](double part) {
    const Vec2 place = (1 - part) * way.from + part * way.to;
    return Vec3(place.x(), place.y(), ground(place));
  };
  return object;
}

SimulatedHand handOver(const DemoObject& object, const DemoMaterial& material, std::uint32_t seed) {
  SimulatedHand hand;
  hand.seed = seed;
  hand.from = material.from;
  const auto& ground = object.ground;
  hand.relief = [ground, height = material.height](const Vec2& place) {
    return ground(place) + height(place);
  };
  hand.normal = object.normal;
  hand.travel_height = ground(material.from) + 10e-3;
  hand.compliance = 1 / material.stiffness;
  const Vec2 &from = material.from, &to = material.to;
  hand.moves.push_back({from, 0.5, 0, 0, 0});
  press(hand, from);
  hand.moves.push_back({from, 0.3, 0, 1.0, 0});
  hand.moves.push_back({to, (to - from).norm() / kSpeed, 0, 1.0, 0});
  hand.moves.push_back({to, 0.2, 0, 0, 0});
  hand.moves.push_back({to, 0.4, 0, 0, 1});
  return hand;
}

SimulatedHand surveyOf(const DemoObject& object, std::uint32_t seed) {
  SimulatedHand hand;
  hand.seed = seed;
  hand.relief = object.ground;
  hand.normal = object.normal;
  hand.from = object.survey.at(0);
  hand.travel_height = hand.relief(hand.from) + 10e-3;
  hand.compliance = 1. / 5000;
  hand.moves.push_back({hand.from, 0.5, 0, 0, 0});
  Vec2 place = hand.from;
  for (const Vec2& to : object.survey) {
    hand.moves.push_back({to, 0.2 + (to - place).norm() / kSpeed, 0, 1.0, 0});
    place = to;
  }
  press(hand, place);
  hand.moves.push_back({place, 0.2, 0, 0, 0});
  hand.moves.push_back({place, 0.4, 0, 0, 1});
  return hand;
}

namespace {

const char* const kFamily = "4x4_50";
constexpr double kEnds = 0.05; // fraction of a profile at each end, blended or slow
// Harmonics are compared if the true amplitude exceeds this times the squared wavelength: ten times
// the noise of such a scan [1/m].
constexpr double kFloor = 5;
constexpr double kMillimetre = 1e3; // .obj units per metre

Pose objectFromCamera(const Demo& demo) {
  return demo.registered.registration.mesh_from_path;
}

// Format for `patina register --truth`.
std::string truthText(const Demo& demo) {
  return Json::object()
             .set("mesh_from_camera", poseJson(demo.camera_from_object.inverse()))
             .dump() +
         "\n";
}

// Writes each scan as a folder that every command and the Scan page open.
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
  const std::vector<RigMarker> cube = printedRig({.family = kFamily}).markers;
  std::uint32_t seed = demo.seed * 100;
  for (const DemoMaterial& material : demo.object.materials)
    demo.scans.push_back(
        {material.name, handOver(demo.object, material, ++seed), {}, 0, 0, {}, {}});
  demo.scans.push_back({"survey", surveyOf(demo.object, ++seed), {}, 0, 0, {}, {}});
  for (std::size_t i = 0; i < demo.scans.size(); ++i) {
    DemoScan& one = demo.scans[i];
    const std::filesystem::path folder = demo.folder / ("scan-" + one.name);
    CaptureSettings course;
    course.seed = ++seed;
    Progress part(progress, [&](double fraction, std::string_view what) {
      progress.report((static_cast<double>(i) + fraction) / static_cast<double>(demo.scans.size()),
                      what);
    });
    one.frames =
        writeFrames(folder, usualCamera(), motionOf(one.hand, demo.rig.probe, camera_from_plane),
                    one.hand.seconds(), cube, course, part);
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
  const std::filesystem::path rig = folder / "rig.json";
  const TrackedFrames found = trackScan(
      {folder.string(), readCamera(folder / "camera.yml"), readMarkers(rig), rig}, progress);
  progress.throwIfCancelled();
  if (found.poses.empty()) throw Error(one.name + ": no frame shows a pose of the markers");
  writePoses(folder / "poses.tum", found.poses, found.without, found.rig_doubt);
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
    one.filtered = contactPath(one.streams, demo.rig, progress);
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

// Heights above the true surface along the planned stroke, by its true arc length; uses no
// measurement.
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
                                     scanPlace(demo.registered.paths[i], demo.registered.of(i)));
    FourierTexture& fitted = texture.scanned.fitted.texture;
    fitted.name = "scan-" + one.name; // name of its folder
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

// Strokes along the scanned paths, coloured; friction where nothing was scanned.
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
  grip.brush.extra_layers = {{Tool::material(MaterialChannel::static_friction), {}, 0.8},
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

constexpr double kDepth = 0.5e-3; // depth of the tip below the mesh [m]
constexpr double kStep = 0.04e-3; // step per tick [m]
constexpr double kMaxLateralDistance =
    0.8e-3; // max lateral distance of the nearest true surface point [m]
constexpr int kLandingTicks = 100;

// Lowers the tip, raises it to half its depth and back, then moves it along the stroke.
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
  // Ends, which are blended or slow, are not evaluated.
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
    ForcePoint point;
    point.along = along;
    point.outward = hand.normal(in_plane[k].head<2>());
    point.felt = felt(k);
    point.truth = referenceForce(surface, in_plane[k], material.stiffness, kMaxLateralDistance);
    rows.rows.push_back({along, point.felt.dot(point.outward), point.truth.dot(point.outward)});
    texture.felt.push_back(point);
  }
  texture.force_error = forceError(texture.felt);
  writeCsv(demo.folder / ("felt-" + material.name + ".csv"), rows);
}

void feelAll(Demo& demo, Progress& progress) {
  for (std::size_t i = 0; i < demo.textures.size(); ++i) {
    progress.report(static_cast<double>(i) / static_cast<double>(demo.textures.size()), "forces");
    feelOne(demo, i, progress);
  }
}

// Writes and reads the mesh as its file has it, so that it equals the commands' mesh bit for bit.
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
      {"register", "The paths are registered to the mesh.", registerAll},
      {"fit", "Accelerations become heights, heights become harmonics.", fit},
      {"map", "Each texture is mapped to the faces under its stroke.", map},
      {"paint", "Colour and friction are painted beside the scanned areas.", paint},
      {"feel", "A tip touches the result, and its force is compared with that of the true surface.",
       feelAll}};
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
