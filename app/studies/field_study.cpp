#include "app/studies/field_study.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "app/studies/field_candidates.h"
#include "app/studies/field_layouts.h"
#include "app/studies/query_timing.h"
#include "app/studies/study_shapes.h"
#include "field/field_sampler.h"

namespace patina {
namespace {

constexpr double kBand = 8;
constexpr double kReach = 0.001; // points lie this close to the surface [m]
constexpr double kDegree = M_PI / 180;

using Query = std::function<CandidateSample(const Vec3&)>; // grid coordinates

struct Probe {
  Vec3 point; // [m]
  double distance;
  Vec3 gradient;
  double from_crease;
};

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

std::vector<Vec3> inGrid(const FieldGrid& grid, const std::vector<Vec3>& points) {
  std::vector<Vec3> result;
  for (const Vec3& p : points) result.push_back(grid.toGrid(p));
  return result;
}

double percentile(const std::vector<double>& sorted, double fraction) {
  return sorted[static_cast<std::size_t>(fraction * static_cast<double>(sorted.size() - 1))];
}

struct Measured {
  double value_rms = 0, value_max = 0;                 // [m]
  double angle_rms = 0, angle_max = 0;                 // [deg]
  std::vector<std::pair<std::string, double>> regions; // direction percentiles [deg]
};

void addPercentiles(Measured& measured, const std::string& region, std::vector<double>& angles) {
  if (angles.empty()) return;
  std::sort(angles.begin(), angles.end());
  for (const auto& [label, fraction] : {std::pair{"p50", 0.5}, {"p95", 0.95}, {"max", 1.0}})
    measured.regions.emplace_back(region + "_" + label + " [deg]", percentile(angles, fraction));
}

// A stencil reaches three nodes; farther than that from an edge the field is smooth.
Measured measure(const FieldGrid& grid, const std::vector<Probe>& probes, const Query& query) {
  Measured measured;
  std::vector<double> smooth, crease;
  for (const Probe& probe : probes) {
    const CandidateSample sample = query(grid.toGrid(probe.point));
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

struct Contender {
  std::string name;
  double value_order, direction_order; // on a smooth shape (F1, F15, MATH section 3)
  std::size_t bytes;
  Query query;
};

// `keep` holds what the queries refer to.
std::vector<Contender> contenders(const SurfaceField& field,
                                  std::vector<std::shared_ptr<const void>>& keep) {
  const auto derivative = std::make_shared<const TrilinearDerivative>(field);
  const auto spline = std::make_shared<const QuadraticSpline>(field);
  keep = {derivative, spline};
  const std::size_t stored =
      field.blockCount() * sizeof(SampleBlock) + field.top.size() * sizeof(field.top[0]);
  const auto own = [&](Sampler kind) -> Query {
    return [sampler = FieldSampler(field, kind)](const Vec3& q) {
      const GridSample sample = sampler.atGrid(q);
      return CandidateSample{sample.phi, sample.gradient};
    };
  };
  return {{"trilinear derivative", 2, 1, derivative->bytes(),
           [derivative](const Vec3& q) { return derivative->atGrid(q); }},
          {"kim", 2, 2, stored, own(Sampler::kim)},
          {"high", 3, 2, stored, own(Sampler::high)},
          {"quadratic spline", 3, 2, spline->bytes(),
           [spline](const Vec3& q) { return spline->atGrid(q); }}};
}

double timed(const std::vector<Vec3>& points, const Query& query) {
  return nsPerQuery(points, [&](const Vec3& q) {
    const CandidateSample sample = query(q);
    return sample.phi + sample.gradient[0];
  });
}

struct Series { // of one sampler over the resolutions
  std::vector<double> h, value, angle;
};

double orderOf(const std::vector<double>& h, const std::vector<double>& error) {
  // The coarsest grid of five is not yet in the asymptotic range.
  const std::size_t skip = h.size() > 3 ? 1 : 0;
  return fittedOrder({h.begin() + static_cast<std::ptrdiff_t>(skip), h.end()},
                     {error.begin() + static_cast<std::ptrdiff_t>(skip), error.end()});
}

struct ShapeTables {
  WorkPrecisionTable value, direction;
};

std::shared_ptr<const SurfaceField> fieldOf(const StudyShape& shape, int resolution) {
  const FieldGrid grid = gridAround(
      shape.bounds, FieldSpec{.resolution = resolution, .voxel = std::nullopt, .band = kBand});
  return withSamples(
      std::make_shared<const SurfaceField>(sampleFunction(shape.distance, grid, kBand)));
}

ShapeTables studyShape(const StudyShape& shape, const std::vector<int>& resolutions,
                       std::size_t points, Progress& progress) {
  const std::vector<Probe> probes = probesNear(shape, points);
  std::vector<Vec3> random_points;
  for (const Probe& probe : probes) random_points.push_back(probe.point);
  const std::vector<Vec3> path = pathAlong(shape, points);

  ShapeTables tables;
  const bool smooth = shape.name != "box";
  tables.value = {"field", "Distance on a " + shape.name + ", rms and max (order: high, F15)",
                  "m",     {},
                  {},      smooth ? std::optional(3.0) : std::nullopt};
  tables.direction = {"field", "Direction on a " + shape.name + ", rms and max (order: kim, F1)",
                      "deg",   {},
                      {},      smooth ? 2.0 : 0.5};
  std::vector<Series> series;
  std::vector<Contender> last;
  for (const int resolution : resolutions) {
    progress.throwIfCancelled();
    progress.report(0, shape.name + " at " + std::to_string(resolution));
    const auto field = fieldOf(shape, resolution);
    std::vector<std::shared_ptr<const void>> keep;
    last = contenders(*field, keep);
    series.resize(last.size());
    for (std::size_t c = 0; c < last.size(); ++c) {
      const Contender& contender = last[c];
      const Measured measured = measure(field->grid, probes, contender.query);
      WorkPrecisionRow row;
      row.knobs = {{"sampler", contender.name}, {"resolution", resolution}};
      row.bytes = static_cast<double>(contender.bytes);
      row.ns = timed(inGrid(field->grid, path), contender.query);
      row.error = measured.value_rms;
      row.error_max = measured.value_max;
      row.more = {
          {"random order [ns]", timed(inGrid(field->grid, random_points), contender.query)}};
      tables.value.rows.push_back(row);
      row.error = measured.angle_rms;
      row.error_max = measured.angle_max;
      row.more.insert(row.more.end(), measured.regions.begin(), measured.regions.end());
      tables.direction.rows.push_back(row);
      series[c].h.push_back(field->grid.voxel);
      series[c].value.push_back(measured.value_rms);
      series[c].angle.push_back(measured.angle_rms);
    }
  }
  for (std::size_t c = 0; c < last.size(); ++c) {
    const double value_order = orderOf(series[c].h, series[c].value);
    const double angle_order = orderOf(series[c].h, series[c].angle);
    for (std::size_t row = c; row < tables.value.rows.size(); row += last.size()) {
      tables.value.rows[row].more.emplace_back("order", value_order);
      tables.direction.rows[row].more.emplace_back("order", angle_order);
    }
    if (last[c].name == "high") tables.value.order_fitted = value_order;
    if (last[c].name == "kim") tables.direction.order_fitted = angle_order;
  }
  return tables;
}

WorkPrecisionTable studyLayouts(const StudyShape& shape, int resolution, std::size_t points,
                                Progress& progress) {
  progress.report(0, "layouts");
  const auto field = fieldOf(shape, resolution);
  const std::vector<Probe> probes = probesNear(shape, points);
  std::vector<Vec3> random_points;
  for (const Probe& probe : probes) random_points.push_back(probe.point);
  const std::vector<Vec3> path = inGrid(field->grid, pathAlong(shape, points));
  random_points = inGrid(field->grid, random_points);

  WorkPrecisionTable table{
      "field", "Layouts of one field on a " + shape.name + ": Kim's blend", "deg", {}, {}, {}};
  for (const auto& layout : fieldLayouts(*field)) {
    progress.throwIfCancelled();
    const Query query = [&](const Vec3& q) { return layout->atGrid(q); };
    const Measured measured = measure(field->grid, probes, query);
    WorkPrecisionRow row;
    row.knobs = {{"layout", layout->name()}, {"resolution", resolution}};
    row.error = measured.angle_rms;
    row.error_max = measured.angle_max;
    row.ns = timed(path, query);
    row.bytes = static_cast<double>(layout->bytes());
    row.more = {{"random order [ns]", timed(random_points, query)},
                {"value rms [m]", measured.value_rms},
                {"value max [m]", measured.value_max}};
    table.rows.push_back(std::move(row));
  }
  return table;
}

} // namespace

std::vector<WorkPrecisionTable> fieldStudy(const StudyOptions& options, Progress& progress) {
  const std::vector<int> resolutions =
      options.quick ? std::vector<int>{64, 112} : std::vector<int>{32, 64, 128, 150, 256};
  const std::size_t points = options.quick ? 4000 : 50000;
  std::vector<WorkPrecisionTable> tables;
  const std::vector<StudyShape> shapes = studyShapes();
  for (const StudyShape& shape : shapes) {
    ShapeTables of_shape = studyShape(shape, resolutions, points, progress);
    tables.push_back(std::move(of_shape.value));
    tables.push_back(std::move(of_shape.direction));
  }
  tables.push_back(studyLayouts(shapes[1], options.quick ? 112 : 150, points, progress));
  progress.report(1, "done");
  return tables;
}

} // namespace patina
