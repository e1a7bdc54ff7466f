#include "app/studies/framework/studies.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "app/studies/field/study_shapes.h"
#include "app/studies/framework/query_timing.h"
#include "field/construction/build_field.h"
#include "field/sampling/field_sampler.h"
#include "field/store/field_grid.h"
#include "field/store/surface_field.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

// Measures samplers at probe points near a known shape.
inline constexpr double kReach = 0.001; // max distance of probes from the surface [m]

// A point with its true distance and gradient.
struct Probe {
  Vec3 point; // [m]
  double distance;
  Vec3 gradient;
  double from_crease;
};

struct Measured {
  double value_rms = 0, value_max = 0;                 // [m]
  double angle_rms = 0, angle_max = 0;                 // [deg]
  std::vector<std::pair<std::string, double>> regions; // direction percentiles [deg]
};

struct Contender {
  std::string name;
  std::size_t bytes;
  FieldSampler sampler; // refers to the field
};

constexpr double kDegree = M_PI / 180;

std::vector<Vec3> inGrid(const FieldGrid& grid, const std::vector<Vec3>& points) {
  std::vector<Vec3> result;
  for (const Vec3& p : points) result.push_back(grid.toGrid(p));
  return result;
}

double percentile(const std::vector<double>& sorted, double fraction) {
  return sorted[static_cast<std::size_t>(fraction * static_cast<double>(sorted.size() - 1))];
}

void addPercentiles(Measured& measured, const std::string& region, std::vector<double>& angles) {
  if (angles.empty()) return;
  std::sort(angles.begin(), angles.end());
  for (const auto& [label, fraction] : {std::pair{"p50", 0.5}, {"p95", 0.95}, {"max", 1.0}})
    measured.regions.emplace_back(region + "_" + label + " [deg]", percentile(angles, fraction));
}

// Spread over the shape; fixed seed.
std::vector<Probe> probesNear(const StudyShape& shape, std::size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Probe> probes;
  while (probes.size() < count) {
    const Vec3 u(unit(random), unit(random), unit(random));
    Vec3 p = shape.bounds.min() + u.cwiseProduct(shape.bounds.sizes());
    const double depth = kReach * (2 * unit(random) - 1);
    p += (depth - shape.distance(p)) * shape.gradient(p);
    if (!p.allFinite() || std::abs(shape.distance(p)) > kReach) continue;
    probes.push_back({p, shape.distance(p), shape.gradient(p), shape.from_crease(p)});
  }
  return probes;
}

std::vector<Vec3> pointsOf(const std::vector<Probe>& probes) {
  std::vector<Vec3> points;
  for (const Probe& probe : probes) points.push_back(probe.point);
  return points;
}

// A servo's path: along the surface in small steps.
std::vector<Vec3> pathAlong(const StudyShape& shape, std::size_t count) {
  std::vector<Vec3> path;
  for (std::size_t n = 0; n < count; ++n) {
    const double t = 0.001 * static_cast<double>(n);
    const double theta = M_PI / 2 + 1.1 * std::sin(0.7 * t), phi = 2.3 * t;
    Vec3 p = 0.04 * Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                         std::cos(theta));
    for (int step = 0; step < 2; ++step)
      p += (0.5 * kReach * std::sin(8 * t) - shape.distance(p)) * shape.gradient(p);
    path.push_back(p);
  }
  return path;
}

// A stencil spans three nodes; farther from an edge the field is smooth.
Measured measure(const FieldGrid& grid, const std::vector<Probe>& probes,
                 const FieldSampler& sampler) {
  Measured measured;
  std::vector<double> smooth, crease;
  for (const Probe& probe : probes) {
    const GridSample sample = sampler.atGrid(grid.toGrid(probe.point));
    const double value = std::abs(sample.phi * grid.voxel - probe.distance);
    const double angle = std::atan2(sample.gradient.cross(probe.gradient).norm(),
                                    sample.gradient.dot(probe.gradient)) /
                         kDegree;
    measured.value_rms += value * value;
    measured.value_max = std::max(measured.value_max, value);
    measured.angle_rms += angle * angle;
    measured.angle_max = std::max(measured.angle_max, angle);
    (probe.from_crease > kReach + 3 * grid.voxel ? smooth : crease).push_back(angle);
  }
  const auto count = static_cast<double>(probes.size());
  measured.value_rms = std::sqrt(measured.value_rms / count);
  measured.angle_rms = std::sqrt(measured.angle_rms / count);
  addPercentiles(measured, "smooth", smooth);
  addPercentiles(measured, "crease", crease);
  return measured;
}

// The field needs its sample layer.
std::vector<Contender> contenders(const SurfaceField& field) {
  const std::size_t stored = field.blockCount() * sizeof(SampleBlock) +
                             field.block_index.size() * sizeof(field.block_index[0]);
  return {{"kim", stored, FieldSampler(field, Sampler::kim)},
          {"high", stored, FieldSampler(field, Sampler::high)}};
}

// [ns]
double timed(const FieldGrid& grid, const std::vector<Vec3>& points, const FieldSampler& sampler) {
  return nsPerQuery(inGrid(grid, points), [&](const Vec3& q) {
    const GridSample sample = sampler.atGrid(q);
    return sample.phi + sample.gradient[0];
  });
}

constexpr double kBand = 8;

FieldSpec specOf(int resolution) {
  return {.resolution = resolution, .voxel = std::nullopt, .band = kBand};
}

std::shared_ptr<const SurfaceField> fieldOf(const StudyShape& shape, int resolution) {
  const FieldGrid grid = gridAround(shape.bounds, specOf(resolution));
  return withSamples(
      std::make_shared<const SurfaceField>(sampleFunction(shape.distance, grid, kBand)));
}

struct Points {
  Points(const StudyShape& shape, std::size_t count)
      : probes(probesNear(shape, count)), random(pointsOf(probes)), path(pathAlong(shape, count)) {}
  std::vector<Probe> probes;
  std::vector<Vec3> random, path;
};

WorkPrecisionRow rowOf(const FieldGrid& grid, const Points& points, const FieldSampler& sampler,
                       std::size_t bytes) {
  WorkPrecisionRow row;
  row.bytes = static_cast<double>(bytes);
  row.ns = timed(grid, points.path, sampler);
  row.more = {{"random order [ns]", timed(grid, points.random, sampler)}};
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

// Adds each sampler's fitted order to its rows, which alternate between `samplers`, and the order
// of `headline` to the table.
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
      const Measured measured = measure(field->grid, points.probes, sampler.sampler);
      WorkPrecisionRow row = rowOf(field->grid, points, sampler.sampler, sampler.bytes);
      row.settings = {{"sampler", sampler.name}, {"resolution", resolution}};
      value.rows.push_back(valueRow(row, measured));
      direction.rows.push_back(directionRow(row, measured));
    }
  }
  fitOrders(value, h, samplers, "high");
  fitOrders(direction, h, samplers, "kim");
  // A box's orders depend on the width of its edges' strips against that of the probes' shell.
  if (shape.name != "box") {
    value.order_expected = 3;
    direction.order_expected = 2;
  }
  tables.push_back(std::move(value));
  tables.push_back(std::move(direction));
}

// A sphere as a triangle mesh: its facets limit all samplers equally.
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
      const Measured measured = measure(field->grid, points.probes, sampler.sampler);
      WorkPrecisionRow row = rowOf(field->grid, points, sampler.sampler, sampler.bytes);
      row.settings = {{"sampler", sampler.name},
                      {"resolution", resolution},
                      {"triangles", mesh.triangles.size()}};
      row.more.emplace_back("value rms [m]", measured.value_rms);
      row.more.emplace_back("value max [m]", measured.value_max);
      table.rows.push_back(directionRow(row, measured));
    }
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
  return tables;
}

} // namespace patina
