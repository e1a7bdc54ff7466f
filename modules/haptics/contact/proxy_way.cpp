// How a proxy enters and leaves contact: crossings of the path with the surface.
#include <algorithm>
#include <cmath>

#include "haptics/contact/proxy.h"

namespace patina {
namespace {

// Lengths in voxels.
constexpr double kOnSurface = 1e-5, kReprojected = 1e-4, kGrazing = 0.02;
constexpr double kMinPathLength = 1; // shorter paths are judged by their end alone
constexpr double kFlat = 0.2;
constexpr double kMinStep = 1.0 / 16;
constexpr int kMaxMarch = 128, kMaxSeek = 24;

} // namespace

bool ProxySearch::isFree(const Vec3& from, double height_from, const Vec3& to, double height_to,
                         int& samples) const noexcept {
  const double way = (to - from).norm();
  return way < kMinPathLength || per_lipschitz_ * (height_from + height_to) >= way ||
         !firstCrossing(from, height_from, to, height_to, samples, kGrazing);
}

std::optional<Vec3> ProxySearch::firstCrossing(const Vec3& from, double height_from, const Vec3& to,
                                               std::optional<double> height_to, int& samples,
                                               double grazing) const noexcept {
  const double length = (to - from).norm();
  if (!(length > 0)) return std::nullopt;
  const Vec3 along = 1 / length * (to - from);
  double outside = 0, inside = -1, above = std::max(height_from, 0.0), below = 0;
  // The end alone decides if the step is shorter than the field's resolution.
  if (height_to && *height_to < 0 && length < kMinPathLength) {
    inside = length;
    below = *height_to;
  }
  for (int i = 0; inside < 0 && i < kMaxMarch; ++i) {
    if (outside >= length) return std::nullopt;
    const double s = std::min(length, outside + std::max(per_lipschitz_ * above, kMinStep));
    const double height = heightAt(from + s * along);
    ++samples;
    if (height < -grazing) {
      inside = s;
      below = height;
    } else {
      outside = s;
      above = std::max(height, 0.0);
    }
  }
  if (inside < 0) { // a path that still grazes the surface is not free
    if (outside >= length || above >= kMinPathLength) return std::nullopt;
    return from + outside * along;
  }
  for (int k = 0; k < 24 && above > kOnSurface; ++k) {
    // False position, kept off the ends so that a kink cannot stall it.
    const double share = std::clamp(above / (above - below), 0.05, 0.95);
    const double s = outside + share * (inside - outside);
    const double height = heightAt(from + s * along);
    ++samples;
    if (height < 0) {
      inside = s;
      below = height;
    } else {
      outside = s;
      above = height;
    }
  }
  return from + outside * along;
}

bool ProxySearch::reproject(const Vec3& x, Vec3& c, int& samples) const noexcept {
  const double height = heightAt(c);
  ++samples;
  if (std::abs(height) < kReprojected) return true;
  const std::optional<Vec3> at =
      height > 0 ? firstCrossing(c, height, x, std::nullopt, samples) : seekSurface(c, samples);
  if (at) c = *at;
  return at.has_value();
}

std::optional<Vec3> ProxySearch::seekSurface(const Vec3& x, int& samples) const noexcept {
  Vec3 q = x;
  for (int i = 0; i < kMaxSeek; ++i) {
    const GridSample sample = sampler_->atGrid(q);
    ++samples;
    const double height = sample.phi - iso_;
    if (sample.region == FieldRegion::band && std::abs(height) < kOnSurface) return q;
    if (sample.region == FieldRegion::interior) {
      // A blend of opposite directions is meaningless; the nodes' nearest surface point replaces
      // it.
      if (const auto feet = sampler_->interiorClosestPoints(q)) {
        q = feet->nearest;
        continue;
      }
    }
    const double squared = sample.gradient.squaredNorm();
    if (!(squared > kFlat * kFlat)) return std::nullopt;
    q -= std::clamp(height, -4.0, 4.0) / squared * sample.gradient;
  }
  return std::nullopt;
}

} // namespace patina
