#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "app/cli/commands/commands.h"
#include "app/cli/input/point_file.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/output/reports.h"
#include "authoring/brush/surface_values.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/numbers.h"
#include "field/sampling/field_sampler.h"
#include "geometry/mesh/joint_mesh.h"
#include "geometry/tree/triangle_tree.h"
#include "scene/surface_pick.h"
#include "visualization/export/field_io.h"

namespace patina::cli {

namespace {

struct SampleOptions {
  std::filesystem::path input, points, output;
  SceneOptions scene;
};

const std::vector<std::string> kSampleColumns = {"x [m]",  "y [m]",  "z [m]",  "phi [m]",
                                                 "nx",     "ny",     "nz",     "face",
                                                 "cx [m]", "cy [m]", "cz [m]", "in_band"};
constexpr std::size_t kPhi = 3, kInBand = 11;

const Keys kSampleKeys = {{"points", "", "points"},
                          {"in_band", "", "in the band", "points", Shown::never},
                          {"bad_points", "", "bad points", "NaN or infinite", Shown::if_any},
                          {"sampler", "", "sampler"},
                          {"voxel", "m", "voxel"}};

// Exact closest points on what can be felt, under the indices of the mesh as given.
class SurfaceOracle {
 public:
  explicit SurfaceOracle(UnionSurface surface)
      : face_of_(std::move(surface.face)), tree_(surface.mesh) {}

  ClosestPoint closest(const Vec3& p) const {
    ClosestPoint found = tree_.closestPoint(p);
    found.surface.face = face_of_[static_cast<std::size_t>(found.surface.face)];
    return found;
  }

 private:
  std::vector<std::int32_t> face_of_;
  TriangleTree tree_;
};

struct SampledSurface {
  std::shared_ptr<const SurfaceField> field;
  std::optional<SurfaceOracle> oracle; // absent: only the field is known
  Sampler sampler = Sampler::high;
  std::shared_ptr<const CompiledScene> compiled; // null: only the field is known
};

// What a scene adds to a field's columns: each channel of material, relief, colour.
void addValueColumns(std::vector<std::string>& columns) {
  for (const Channel& row : kChannels)
    columns.push_back(std::string(row.key) +
                      (row.unit.empty() ? "" : " [" + std::string(row.unit) + "]"));
  columns.insert(columns.end(), {"relief [m]", "red", "green", "blue", "cover"});
}

// As painted at the closest point; where nothing is, the scene's own, and no colour.
void addValues(const Scene& scene, const TriangleMesh& mesh, std::int32_t face, const Vec3& closest,
               std::vector<double>& row) {
  SurfaceValues values;
  values.material = baseMaterial(scene.haptics);
  if (face >= 0) {
    const auto t = static_cast<std::size_t>(face);
    const Vec3 at =
        closestBarycentric(closest, mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
    if (const auto own = objectPointOf(scene, {face, at}))
      values = surfaceValues(scene, own->object, own->point);
  }
  for (const Channel& channel : kChannels) row.push_back(values.material.*channel.value);
  row.push_back(values.height);
  const double cover = values.color[3];
  for (std::size_t c = 0; c < 3; ++c) row.push_back(cover > 0 ? values.color[c] / cover : 0);
  row.push_back(cover);
}

SampledSurface open(const SampleOptions& options, Console& console) {
  SampledSurface surface;
  if (isFieldFile(options.input)) {
    if (options.scene.open.unit_chosen)
      console.warn(options.input.string() + ": --unit has no effect on a field");
    if (options.scene.open.iso) throw Error("--iso: a field is sampled as it is; phi is given");
    Scene scene;
    for (const auto& [key, value] : options.scene.settings) {
      if (key != "sampler") throw Error("--" + key + ": the field in the file has its own");
      setValue(scene, key, value);
    }
    surface.field = withSamples(std::make_shared<const SurfaceField>(readField(options.input)));
    surface.sampler = scene.sampler;
    return surface;
  }
  const auto compiled = compileFor(openWith(options.input, options.scene, console), console);
  surface.field = compiled->paint.field;
  surface.oracle.emplace(feltTriangles(*compiled, console.progress()));
  surface.sampler = compiled->scene.sampler;
  surface.compiled = compiled;
  return surface;
}

std::vector<double> sampleRow(const SampledSurface& surface, const FieldSampler& sampler,
                              const Vec3& p) {
  const GridSample sample = sampler.at(p);
  const bool in_band = p.allFinite() && sample.region == FieldRegion::band;
  double phi = sample.phi;
  Vec3 normal = sample.gradient.norm() > 0 ? Vec3(sample.gradient.normalized()) : Vec3::Zero();
  Vec3 closest = p - phi * normal;
  std::int32_t face = -1;
  if (!p.allFinite()) {
    phi = std::numeric_limits<double>::quiet_NaN();
    normal.setConstant(phi);
    closest.setConstant(phi);
  } else if (surface.oracle) {
    const ClosestPoint exact = surface.oracle->closest(p);
    closest = exact.point;
    face = exact.surface.face;
    if (!in_band) { // the field only bounds the distance here
      const double sign = sample.region == FieldRegion::deep ? -1 : 1;
      phi = sign * exact.distance;
      normal = exact.distance > 0 ? Vec3(sign * (p - closest) / exact.distance) : Vec3::Zero();
    }
  } else {
    face = sampler.faceNear(p);
  }
  std::vector<double> row{p.x(),       p.y(),       p.z(),       phi,
                          normal.x(),  normal.y(),  normal.z(),  static_cast<double>(face),
                          closest.x(), closest.y(), closest.z(), in_band ? 1.0 : 0.0};
  if (surface.compiled)
    addValues(surface.compiled->scene, *surface.compiled->mesh, face, closest, row);
  return row;
}

int runSample(const SampleOptions& options, Console& console) {
  requireWritable(options.output, {options.input, options.points}, FileKind::table);
  PointReader points(options.points);
  std::optional<Vec3> p = points.next(); // one that is wrong from the start is refused now
  console.warn(points.table().leftOut());
  const SampledSurface surface = open(options, console);
  const FieldSampler sampler(*surface.field, surface.sampler);
  std::vector<std::string> columns = kSampleColumns;
  if (surface.compiled) addValueColumns(columns);
  CsvWriter samples(options.output, columns);
  std::size_t count = 0, in_band = 0, bad_points = 0;
  for (; p; p = points.next()) {
    if (count++ % 1024 == 0) console.progress().throwIfCancelled();
    const std::vector<double> sample = sampleRow(surface, sampler, *p);
    samples.add(sample);
    in_band += sample[kInBand] != 0;
    bad_points += std::isnan(sample[kPhi]);
  }
  console.progress().throwIfCancelled();
  samples.commit();

  if (bad_points)
    console.warn(options.points.string() + ": " + formatCount(bad_points) +
                 (bad_points == 1 ? " point is" : " points are") + " NaN or infinite; " +
                 points.table().firstNotFinite());
  Report report(kSampleKeys);
  report.set("points", count, formatCount(count) + ", in the band " + formatCount(in_band));
  report.set("in_band", in_band).set("bad_points", bad_points);
  report.set("sampler", std::string(name(surface.sampler)));
  report.set("voxel", surface.field->grid.voxel);
  return console.report(report);
}

} // namespace

Command sampleCommand() {
  auto options = std::make_shared<SampleOptions>();
  Command command{
      .name = "sample",
      .summary = "distance, direction, nearest face and material at points",
      .description =
          "Points come with the columns x [m],y [m],z [m], in any order and any unit of length; "
          "the times and forces of a path are not read, other columns are left out with a "
          "warning. Out go phi [m] (negative inside), the "
          "unit direction nx,ny,nz, the nearest face, the closest point cx,cy,cz [m], in_band (1 "
          "or 0).\n"
          "With a mesh or workspace also every channel of material, relief [m], red, green, blue "
          "and cover: as painted at the closest point, the scene's own elsewhere; the face and "
          "closest point are exact, and so are phi and the "
          "direction beyond the band; of several objects the closest point is one of their "
          "union's, which none of them hides. Where relief is baked, phi and the direction are "
          "those of the relief. With a field alone they are what the field knows: closest point = "
          "point - phi n, and beyond the band phi is a bound outside, the coarse nodes' estimate "
          "inside; trust neither where in_band is 0.",
      .examples = {"patina sample bunny.ply --points points.csv -o samples.csv",
                   "patina sample bunny.vti --points tip.csv -o samples.csv --sampler kim"},
      .keys = kSampleKeys,
      .arguments = {sceneInput(options->input),
                    {"--points", "POINTS.csv", "", "", "The points.", into(options->points),
                     Times::once},
                    outputTo(options->output, "SAMPLES.csv", "One row a point.")},
      .run = [options](Console& console) { return runSample(*options, console); }};
  addSampledFieldOptions(command, options->scene);
  return command;
}

} // namespace patina::cli
