#include "app/studies/field/field_measure.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "app/studies/query_timing.h"
#include "field/sampling/field_sampler.h"

namespace patina {
namespace {

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

} // namespace

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

std::vector<Contender> contenders(const SurfaceField& field) {
  const auto derivative = std::make_shared<const TrilinearDerivative>(field);
  const auto spline = std::make_shared<const QuadraticSpline>(field);
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

double timed(const FieldGrid& grid, const std::vector<Vec3>& points, const Query& query) {
  return nsPerQuery(inGrid(grid, points), [&](const Vec3& q) {
    const CandidateSample sample = query(q);
    return sample.phi + sample.gradient[0];
  });
}

} // namespace patina
