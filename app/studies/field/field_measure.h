// What the field studies measure: contenders at probe points near a known shape.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/studies/field/field_candidates.h"
#include "app/studies/study_shapes.h"
#include "field/store/field_grid.h"

namespace patina {

inline constexpr double kReach = 0.001; // probes lie this close to the surface [m]

// A point and the truth there.
struct Probe {
  Vec3 point; // [m]
  double distance;
  Vec3 gradient;
  double from_crease;
};

// Spread over the shape; fixed seed.
std::vector<Probe> probesNear(const StudyShape& shape, std::size_t count);
std::vector<Vec3> pointsOf(const std::vector<Probe>& probes);
// A servo's path: along the surface in small steps.
std::vector<Vec3> pathAlong(const StudyShape& shape, std::size_t count);

using Query = std::function<CandidateSample(const Vec3&)>; // grid coordinates

struct Measured {
  double value_rms = 0, value_max = 0;                 // [m]
  double angle_rms = 0, angle_max = 0;                 // [deg]
  std::vector<std::pair<std::string, double>> regions; // direction percentiles [deg]
};

Measured measure(const FieldGrid& grid, const std::vector<Probe>& probes, const Query& query);
double timed(const FieldGrid& grid, const std::vector<Vec3>& points, const Query& query); // [ns]

struct Contender {
  std::string name;
  double value_order, direction_order; // on a smooth shape (F1, F15, MATH 3)
  std::size_t bytes;
  Query query; // owns what it needs, but refers to the field
};

// The field needs its sample layer.
std::vector<Contender> contenders(const SurfaceField& field);

} // namespace patina
