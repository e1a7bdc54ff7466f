#include "app/studies/field/field_study.h"

#include "app/studies/field/field_layouts.h"
#include "app/studies/field/field_measure.h"
#include "field/build/build_field.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

constexpr double kBand = 8;

FieldSpec specOf(int resolution) {
  return {.resolution = resolution, .voxel = std::nullopt, .band = kBand};
}

std::shared_ptr<const SurfaceField> fieldOf(const StudyShape& shape, int resolution) {
  const FieldGrid grid = gridAround(shape.bounds, specOf(resolution));
  return withSamples(
      std::make_shared<const SurfaceField>(sampleFunction(shape.distance, grid, kBand)));
}

// Where the points of one study lie.
struct Points {
  Points(const StudyShape& shape, std::size_t count)
      : probes(probesNear(shape, count)), random(pointsOf(probes)), path(pathAlong(shape, count)) {}
  std::vector<Probe> probes;
  std::vector<Vec3> random, path;
};

// All but the errors.
WorkPrecisionRow rowOf(const FieldGrid& grid, const Points& points, const Query& query,
                       std::size_t bytes) {
  WorkPrecisionRow row;
  row.bytes = static_cast<double>(bytes);
  row.ns = timed(grid, points.path, query);
  row.more = {{"random order [ns]", timed(grid, points.random, query)}};
  return row;
}

WorkPrecisionRow valueRow(WorkPrecisionRow row, const Measured& measured) {
  row.error = measured.value_rms;
  row.error_max = measured.value_max;
  return row;
}

WorkPrecisionRow directionRow(WorkPrecisionRow row, const Measured& measured) {
  row.error = measured.angle_rms;
  row.error_max = measured.angle_max;
  row.more.insert(row.more.end(), measured.regions.begin(), measured.regions.end());
  return row;
}

// Appends each sampler's fitted order to its rows, which alternate between `samplers` of them, and
// the headline one's to the table.
void fitOrders(WorkPrecisionTable& table, const std::vector<double>& h,
               const std::vector<Contender>& samplers, const std::string& headline) {
  // The coarsest grid of five is not yet in the asymptotic range.
  const std::size_t skip = h.size() > 3 ? 1 : 0;
  for (std::size_t s = 0; s < samplers.size(); ++s) {
    std::vector<double> steps, errors;
    for (std::size_t level = skip; level < h.size(); ++level) {
      steps.push_back(h[level]);
      errors.push_back(table.rows[level * samplers.size() + s].error);
    }
    const double order = fittedOrder(steps, errors);
    for (std::size_t row = s; row < table.rows.size(); row += samplers.size())
      table.rows[row].more.emplace_back("order", order);
    if (samplers[s].name == headline) table.order_fitted = order;
  }
}

void studyShape(const StudyShape& shape, const std::vector<int>& resolutions, std::size_t count,
                Progress& progress, double from, double to,
                std::vector<WorkPrecisionTable>& tables) {
  const Points points(shape, count);
  WorkPrecisionTable value =
      tableOf("Distance on a " + shape.name + ", rms and max; order of high (F15)", "m");
  WorkPrecisionTable direction =
      tableOf("Direction on a " + shape.name + ", rms and max; order of kim (F1)", "deg");
  std::vector<double> h;
  std::vector<Contender> samplers;
  for (const int resolution : resolutions) {
    progress.throwIfCancelled();
    progress.report(from + (to - from) * static_cast<double>(h.size()) /
                               static_cast<double>(resolutions.size()),
                    shape.name + " at " + std::to_string(resolution));
    const auto field = fieldOf(shape, resolution);
    h.push_back(field->grid.voxel);
    samplers = contenders(*field);
    for (const Contender& sampler : samplers) {
      const Measured measured = measure(field->grid, points.probes, sampler.query);
      WorkPrecisionRow row = rowOf(field->grid, points, sampler.query, sampler.bytes);
      row.knobs = {{"sampler", sampler.name}, {"resolution", resolution}};
      value.rows.push_back(valueRow(row, measured));
      direction.rows.push_back(directionRow(row, measured));
    }
  }
  fitOrders(value, h, samplers, "high");
  fitOrders(direction, h, samplers, "kim");
  // A box's orders depend on how wide its edges' strips are beside the probes' shell.
  if (shape.name != "box") {
    value.order_expected = 3;
    direction.order_expected = 2;
  }
  tables.push_back(std::move(value));
  tables.push_back(std::move(direction));
}

// A sphere again, but known only through triangles: their facets limit every sampler alike.
WorkPrecisionTable studyMesh(const StudyShape& sphere, const std::vector<int>& frequencies,
                             int resolution, std::size_t count, Progress& progress) {
  const Points points(sphere, count);
  WorkPrecisionTable table = tableOf("Direction on a sphere of triangles, rms and max", "deg");
  for (const int frequency : frequencies) {
    progress.throwIfCancelled();
    const TriangleMesh mesh = icosphere(0.5 * sphere.bounds.sizes().x(), frequency);
    progress.report(0.75, "sphere of " + std::to_string(mesh.triangles.size()) + " triangles");
    Progress build;
    const auto field = withSamples(buildField(mesh, specOf(resolution), build).field);
    for (const Contender& sampler : contenders(*field)) {
      const Measured measured = measure(field->grid, points.probes, sampler.query);
      WorkPrecisionRow row = rowOf(field->grid, points, sampler.query, sampler.bytes);
      row.knobs = {{"sampler", sampler.name},
                   {"resolution", resolution},
                   {"triangles", mesh.triangles.size()}};
      row.more.emplace_back("value rms [m]", measured.value_rms);
      row.more.emplace_back("value max [m]", measured.value_max);
      table.rows.push_back(directionRow(row, measured));
    }
  }
  return table;
}

WorkPrecisionTable studyLayouts(const StudyShape& shape, int resolution, std::size_t count,
                                Progress& progress) {
  progress.report(0.9, "layouts");
  const auto field = fieldOf(shape, resolution);
  const Points points(shape, count);
  WorkPrecisionTable table =
      tableOf("Layouts of one field on a " + shape.name + ": Kim's blend", "deg");
  for (const auto& layout : fieldLayouts(*field)) {
    progress.throwIfCancelled();
    const Query query = [&](const Vec3& q) { return layout->atGrid(q); };
    const Measured measured = measure(field->grid, points.probes, query);
    WorkPrecisionRow row = rowOf(field->grid, points, query, layout->bytes());
    row.knobs = {{"layout", layout->name()}, {"resolution", resolution}};
    row.more.emplace_back("value rms [m]", measured.value_rms);
    row.more.emplace_back("value max [m]", measured.value_max);
    row.error = measured.angle_rms;
    row.error_max = measured.angle_max;
    table.rows.push_back(std::move(row));
  }
  return table;
}

} // namespace

std::vector<WorkPrecisionTable> fieldStudy(const StudyOptions& options, Progress& progress) {
  const bool quick = options.quick;
  const std::vector<int> resolutions =
      quick ? std::vector{64, 112} : std::vector{32, 64, 128, 150, 256};
  const std::size_t count = quick ? 4000 : 50000;
  const std::vector<StudyShape> shapes = studyShapes();
  std::vector<WorkPrecisionTable> tables;
  for (std::size_t s = 0; s < shapes.size(); ++s)
    studyShape(shapes[s], resolutions, count, progress, 0.25 * static_cast<double>(s),
               0.25 * static_cast<double>(s + 1), tables);
  tables.push_back(studyMesh(shapes[0], quick ? std::vector{7, 22} : std::vector{22, 71, 224},
                             quick ? 64 : 150, count, progress));
  tables.push_back(studyLayouts(shapes[1], quick ? 112 : 150, count, progress));
  return tables;
}

} // namespace patina
