#include "authoring/brush/stroke_path.h"

#include <algorithm>
#include <cmath>

#include "authoring/brush/painter.h"

namespace patina {
namespace {

constexpr double kRadiusSeconds = 0.05;
constexpr double kMostDabsAVoxel = 64;
constexpr double kFarthest = 1e9;       // voxels: beyond it steps are lost in rounding
constexpr double kMostDabsARadius = 32; // of the wider end, where the radius falls to nothing

struct Interval {
  double from = 0, to = 1;
};

// The part of the way from a to b that the field knows of; empty if from > to.
Interval within(const FieldGrid& grid, const Vec3& a, const Vec3& b) {
  Interval part;
  const Vec3 start = grid.toGrid(a), way = grid.toGrid(b) - start;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = -1, high = grid.nodes[static_cast<std::size_t>(axis)];
    if (way[axis] == 0) {
      if (!(start[axis] >= low && start[axis] <= high)) return {1, 0};
      continue;
    }
    double first = (low - start[axis]) / way[axis], last = (high - start[axis]) / way[axis];
    if (first > last) std::swap(first, last);
    part.from = std::max(part.from, first);
    part.to = std::min(part.to, last);
  }
  return part;
}

} // namespace

std::vector<PathStep> StrokePath::to(const StrokeSample& sample) {
  reached_ = false;
  const bool finite = sample.position.allFinite() && std::isfinite(sample.force) &&
                      std::isfinite(sample.t) && (!sample.tip || sample.tip->allFinite());
  if (!finite || grid_.toGrid(sample.position).cwiseAbs().maxCoeff() > kFarthest) return {};
  const double target = brushRadius(brush_, sample.force);
  if (!last_) {
    last_ = sample;
    radius_ = target;
    reached_ = true;
    return {{sample.position, radius_, false, sample.tip}};
  }
  const StrokeSample from = *last_;
  const double radius = radius_;
  const double seconds = std::max(0.0, sample.t - from.t);
  radius_ += (target - radius) * -std::expm1(-seconds / kRadiusSeconds);
  last_ = sample;

  const Vec3 way = sample.position - from.position;
  const double step =
      std::max({std::min(radius, radius_) / 4, std::max(radius, radius_) / kMostDabsARadius,
                grid_.voxel / kMostDabsAVoxel});
  // What rounding adds to a whole number is no step.
  const double count = std::max(1.0, std::ceil(way.norm() / step - 1e-9));
  const Interval known = within(grid_, from.position, sample.position);
  std::vector<PathStep> steps;
  if (!(known.from <= known.to)) return steps;
  const double first = std::max(1.0, std::ceil(known.from * count));
  const double last = std::min(count, std::floor(known.to * count));
  for (double k = first; k <= last; ++k) {
    const double t = k / count;
    steps.push_back(
        {from.position + t * way, radius + t * (radius_ - radius), k > first || k == 1});
    if (from.tip && sample.tip) steps.back().tip = *from.tip + t * (*sample.tip - *from.tip);
  }
  reached_ = last == count && first <= last;
  if (!reached_) return steps;
  steps.back().position = sample.position;
  steps.back().tip = sample.tip;
  return steps;
}

} // namespace patina
