#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/commands/commands.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/output/reports.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "core/types.h"
#include "field/sampling/field_sampler.h"
#include "geometry/mesh/combined_mesh.h"
#include "geometry/tree/triangle_tree.h"
#include "session/compile/probe_table.h"
#include "visualization/export/export_files.h"
#include "visualization/files/field_io.h"

namespace patina::cli {
namespace {

// Points from a table with x [m], y [m], z [m]; times are ignored.

// Throws FileError with the line: another header, an invalid number.
class PointReader {
 public:
  explicit PointReader(const std::filesystem::path& path);
  std::optional<Vec3> next(); // nullopt at the end
  const CsvReader& table() const { return rows_; }

 private:
  CsvReader rows_;
  std::vector<double> row_;
};

PointReader::PointReader(const std::filesystem::path& path)
    : rows_(path, {{"x [m]", "y [m]", "z [m]"}, {}, toolSampleColumns()}) {}

std::optional<Vec3> PointReader::next() {
  if (!rows_.next(row_)) return std::nullopt;
  return Vec3(row_[0], row_[1], row_[2]);
}

struct SampleOptions {
  std::filesystem::path input, points, output;
  std::optional<std::pair<Vec3, Vec3>> line;
  int count = 201; // points along the line
  std::vector<Vec3> at;
  bool pins = false;
  SceneOptions scene;
};

// Keys of one point of --at; a field alone has no values.
Keys atKeys() {
  Keys keys = {{"pin", "", "pin", "its name"},
               {"position", "m", "position"},
               {"phi", "m", "distance", "negative inside"},
               {"gradient", "", "gradient"},
               {"closest", "m", "closest point"},
               {"in_band", "", "in the band", "", Shown::never},
               {"object", "", "object"}};
  for (const Channel& row : kChannels)
    keys.push_back(
        {std::string(row.key), std::string(row.unit), std::string(row.caption), "", Shown::if_any});
  keys.insert(keys.end(), {{"relief", "m", "relief", "", Shown::if_any},
                           {"texture", "m", "texture", "height of a scanned texture"},
                           {"cover", "", "painted cover", "0 to 1", Shown::if_any},
                           {"color", "", "colour", "painted red, green, blue, 0 to 1"}});
  return keys;
}
const Keys kAtKeys = atKeys();

const Keys kSampleKeys = {
    {"at", "", "at", "one entry a point of --at and a pin", Shown::never, kAtKeys},
    {"points", "", "points"},
    {"in_band", "", "in the band", "points", Shown::never},
    {"bad_points", "", "bad points", "NaN or infinite", Shown::if_any},
    {"sampler", "", "sampler"},
    {"voxel", "m", "voxel"}};

// Exact closest points on the union's surface, with the face indices of the input mesh.
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
  std::optional<SurfaceOracle> oracle; // absent for a field file
  Sampler sampler = Sampler::high;
  std::shared_ptr<const CompiledScene> compiled; // null for a field file
};

std::pair<Vec3, Vec3> parseLine(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) throw Error("'" + text + "' is no line: X,Y,Z:X,Y,Z");
  return {parsePoint(text.substr(0, colon)), parsePoint(text.substr(colon + 1))};
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
  const auto compiled = compileFor(openWith(options.input, options.scene, console), console,
                                   options.pins ? FaceLayer::always : FaceLayer::on_demand);
  surface.field = compiled->paint.field;
  surface.oracle.emplace(hapticTriangles(*compiled, console.progress()));
  surface.sampler = compiled->scene.sampler;
  surface.compiled = compiled;
  return surface;
}

// Probe of a field without its scene: the closest point follows from phi and the gradient.
Probe probeOf(const FieldSampler& sampler, const Vec3& p) {
  Probe probe;
  const GridSample sample = sampler.at(p);
  probe.position = p;
  probe.in_band = p.allFinite() && sample.region == FieldRegion::band;
  probe.distance = p.allFinite() ? sample.phi : std::numeric_limits<double>::quiet_NaN();
  probe.gradient = sample.gradient;
  if (!p.allFinite()) return probe;
  probe.closest.surface.face = sampler.faceNear(p);
  probe.closest.distance = std::abs(sample.phi);
  if (sample.gradient.norm() > 0)
    probe.closest.point = p - sample.phi * sample.gradient.normalized();
  else
    probe.closest.point = p;
  return probe;
}

Probe probeOf(const SampledSurface& surface, const Vec3& p) {
  if (!surface.oracle) return probeOf(FieldSampler(*surface.field, surface.sampler), p);
  const ClosestPoint closest = p.allFinite() ? surface.oracle->closest(p) : Probe{}.closest;
  return probeAt(*surface.compiled, p, closest);
}

Json jsonOf(const Vec3& v) {
  return Json(Json::Array{v.x(), v.y(), v.z()});
}

std::string textOf(const Vec3& metres) {
  return formatLength(metres.x()) + ", " + formatLength(metres.y()) + ", " +
         formatLength(metres.z());
}

Report reportOf(const Probe& probe, const CompiledScene* scene, const std::string& pin = {}) {
  Report report(kAtKeys);
  if (!pin.empty()) report.set("pin", pin);
  report.set("position", jsonOf(probe.position), textOf(probe.position));
  report.set("phi", probe.distance);
  const Vec3& g = probe.gradient;
  report.set("gradient", jsonOf(g), rounded(g.x()) + ", " + rounded(g.y()) + ", " + rounded(g.z()));
  report.set("closest", jsonOf(probe.closest.point), textOf(probe.closest.point));
  report.set("in_band", probe.in_band);
  if (scene == nullptr) return report;
  if (probe.object) report.set("object", scene->scene.objects[*probe.object].name);
  const SurfaceValues& values = probe.values;
  for (const Channel& row : kChannels) report.set(row.key, values.material.*row.value);
  if (probe.texture) report.set("texture", *probe.texture);
  report.set("relief", values.height).set("cover", values.color[3]);
  if (const double cover = values.color[3]; cover > 0)
    report.set("color", jsonOf(Vec3(values.color[0], values.color[1], values.color[2]) / cover));
  return report;
}

// Samples --at, which is reported, then the points of --line or --points.
class SampleInput {
 public:
  explicit SampleInput(const SampleOptions& options) : at_(options.at) {
    if (!options.points.empty()) points_.emplace(options.points);
    for (int i = 0; options.line && i < options.count; ++i) {
      const double part = static_cast<double>(i) / (options.count - 1);
      at_.push_back(options.line->first + part * (options.line->second - options.line->first));
    }
  }
  std::optional<Vec3> next() {
    if (count_ < at_.size()) return at_[count_++];
    return points_ ? points_->next() : std::nullopt;
  }
  const std::optional<PointReader>& points() const { return points_; }

 private:
  std::vector<Vec3> at_;
  std::size_t count_ = 0;
  std::optional<PointReader> points_;
};

// Adds the rows of each point, and all of them as one list.
void addPoints(Report& report, const std::vector<Report>& points) {
  for (const Report& point : points) report.set("at", point);
  if (!points.empty()) report.set("at", points);
}

int reportPins(const SampleOptions& options, const SampledSurface& surface, Console& console) {
  if (!surface.compiled) throw Error("--pins: a field has none; name a workspace");
  const CompiledScene& scene = *surface.compiled;
  std::vector<Report> reports;
  for (const Pin& pin : scene.scene.pins)
    reports.push_back(reportOf(probeOf(surface, pin.position), &scene, pin.name));
  if (!options.output.empty())
    writeFileAtomically(options.output, pinTable(scene, [&](const Vec3& position) {
                          return probeOf(surface, position);
                        }));
  Report report(kSampleKeys);
  addPoints(report, reports);
  report.set("points", reports.size());
  return console.report(report);
}

int runSample(const SampleOptions& options, Console& console) {
  const bool has_table = !options.points.empty() || options.line;
  if (options.pins && (has_table || !options.at.empty()))
    throw Error("--pins: --points, --line and --at name other points");
  if (!options.points.empty() && options.line)
    throw Error("--line: --points names other points; one of them");
  if (!has_table && options.at.empty() && !options.pins)
    throw Error("--points, --line, --at or --pins: name the points to sample");
  if (options.output.empty() && has_table)
    throw Error("--output: name the table for the points of --points or --line");
  std::vector<std::filesystem::path> inputs{options.input};
  if (!options.points.empty()) inputs.push_back(options.points);
  if (!options.output.empty()) requireWritable(options.output, inputs, FileKind::table);
  SampleInput input(options);
  std::optional<Vec3> p = input.next(); // an invalid first point is rejected before the work
  if (input.points()) console.warn(input.points()->table().leftOut());
  const SampledSurface surface = open(options, console);
  if (options.pins) return reportPins(options, surface, console);
  const bool has_values = surface.compiled != nullptr;
  std::optional<CsvWriter> samples;
  if (!options.output.empty()) samples.emplace(options.output, probeColumns(has_values));
  std::vector<Report> reports;
  std::size_t count = 0, in_band = 0, bad_points = 0;
  for (; p; p = input.next()) {
    if (count++ % 1024 == 0) console.progress().throwIfCancelled();
    const Probe probe = probeOf(surface, *p);
    if (samples) samples->add(probeRow(probe, has_values));
    if (count <= options.at.size()) reports.push_back(reportOf(probe, surface.compiled.get()));
    in_band += probe.in_band;
    bad_points += std::isnan(probe.distance);
  }
  console.progress().throwIfCancelled();
  if (samples) samples->commit();

  if (bad_points)
    console.warn(options.points.string() + ": " + formatCount(bad_points) +
                 (bad_points == 1 ? " point is" : " points are") + " NaN or infinite; " +
                 (input.points() ? input.points()->table().firstNotFinite() : "see --at"));
  Report report(kSampleKeys);
  addPoints(report, reports);
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
          "the times and forces of a path are not read, other columns are left out with a warning. "
          "--line takes points along a line instead. The output has phi [m] (negative inside), the "
          "unit direction nx,ny,nz, the nearest face, the closest point cx,cy,cz [m], in_band (1 "
          "or 0). --at reports the same of single points, --pins of the points pinned in the "
          "window; they need no --output.\n"
          "With a mesh or workspace also every channel of material, relief [m], red, green, blue, "
          "cover and texture [m], the height of a scanned one: as painted at the closest point, "
          "the scene's own elsewhere; the face and "
          "closest point are exact, and so are phi and the direction beyond the band; of several "
          "objects the closest point is one of their union's, which none of them hides. Where "
          "relief is baked, phi and the direction are those of the relief. With a field alone they "
          "come from the field: closest point = point - phi n, and beyond the band phi is a bound "
          "outside, the coarse nodes' estimate inside; both are unreliable where in_band is 0.",
      .examples = {"patina sample bunny.ply --points points.csv -o samples.csv",
                   "patina sample bunny.ply --line 0,0,20mm:0,0,40mm -o profile.csv",
                   "patina sample bunny.ply --at 0,0,49mm",
                   "patina sample bunny.vti --points tip.csv -o samples.csv --sampler kim"},
      .keys = kSampleKeys,
      .arguments = {sceneInput(options->input),
                    {"--points", "POINTS.csv", "", "", "The points.", into(options->points)},
                    {"--line", "X,Y,Z:X,Y,Z", "m", "",
                     "Points from one end of a line to the other instead, as 0,0,20mm:0,0,40mm.",
                     parsedInto(options->line, parseLine)},
                    {"--count", "N", "", std::to_string(options->count), "Points on the line.",
                     numberInto(2, 1e7, options->count, NumberKind::whole)},
                    {"--at", "X,Y,Z", "m", "", "A point, whose values are reported.",
                     [options](const std::string& text) {
                       options->at.push_back(parsePoint(text));
                     },
                     Times::any},
                    {"--pins", "", "", "", "The pins of the workspace.", into(options->pins)},
                    writtenTo(options->output, "-o,--output", "SAMPLES.csv", "One row a point.")},
      .run = [options](Console& console) { return runSample(*options, console); }};
  addSampledFieldOptions(command, options->scene);
  return command;
}

} // namespace patina::cli
