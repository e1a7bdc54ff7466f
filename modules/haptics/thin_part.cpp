#include "haptics/thin_part.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

constexpr double kMinStep = 1.0 / 16;
constexpr int kMaxMarch = 128;
constexpr int kMaxBisections = 24;
constexpr int kMaxWalk = 8;
constexpr double kMinGradient = 0.1; // K05

std::optional<SurfaceContact> ontoSurface(const FieldSampler& sampler, Vec3 q,
                                          double iso) noexcept {
  for (int i = 0; i < 4; ++i) {
    const GridSample sample = sampler.atGrid(q);
    const double squared = sample.gradient.squaredNorm();
    if (sample.region != FieldRegion::band || !(squared > kMinGradient * kMinGradient)) {
      return std::nullopt;
    }
    const double f = sample.phi - iso;
    q -= std::clamp(f, -1.0, 1.0) / squared * sample.gradient;
    if (std::abs(f) < 1e-6) return SurfaceContact{q, sample.gradient / std::sqrt(squared)};
  }
  return std::nullopt;
}

} // namespace

std::optional<SurfaceContact> firstCrossing(const FieldSampler& sampler, const Vec3& from,
                                            const Vec3& to, double iso) noexcept {
  const double length = (to - from).norm();
  if (!(length > 0)) return std::nullopt;
  const Vec3 along = (to - from) / length;
  double outside = 0;
  double s = 0;
  for (int i = 0; i < kMaxMarch; ++i) {
    const double f = sampler.phiAtGrid(from + s * along) - iso;
    if (f < 0) {
      double inside = s;
      for (int k = 0; k < kMaxBisections; ++k) {
        const double middle = 0.5 * (inside + outside);
        (sampler.phiAtGrid(from + middle * along) < iso ? inside : outside) = middle;
      }
      return ontoSurface(sampler, from + outside * along, iso);
    }
    if (s >= length) return std::nullopt;
    outside = s;
    s = std::min(length, s + std::max(f, kMinStep));
  }
  return std::nullopt;
}

std::optional<SurfaceContact> trackFoot(const FieldSampler& sampler, const Vec3& q,
                                        SurfaceContact start, double iso, double reach) noexcept {
  std::optional<SurfaceContact> foot = ontoSurface(sampler, start.point, iso);
  for (int i = 0; foot && reach > 0 && i < kMaxWalk; ++i) {
    const Vec3 to_tip = q - foot->point;
    Vec3 slide = to_tip - to_tip.dot(foot->normal) * foot->normal;
    const double length = slide.norm();
    if (length < 1e-6) break;
    const double most = std::min(1.0, reach);
    if (length > most) slide *= most / length;
    reach -= std::min(length, most);
    foot = ontoSurface(sampler, foot->point + slide, iso);
  }
  return foot;
}

std::optional<Vec3> descendToNearest(const FieldSampler& sampler, const Vec3& q, const Vec3& start,
                                     double iso) noexcept {
  constexpr int kMaxDescent = 12;
  std::optional<SurfaceContact> foot = ontoSurface(sampler, start, iso);
  if (!foot) return std::nullopt;
  double step = 1;
  for (int i = 0; i < kMaxDescent && step >= kMinStep; ++i) {
    const Vec3 to_tip = q - foot->point;
    const Vec3 slide = to_tip - to_tip.dot(foot->normal) * foot->normal;
    const double length = slide.norm();
    if (length < 1e-6) break;
    const auto next = ontoSurface(sampler, foot->point + std::min(1.0, step / length) * slide, iso);
    if (next && (q - next->point).squaredNorm() < to_tip.squaredNorm())
      foot = next;
    else
      step *= 0.5;
  }
  return foot->point;
}

} // namespace patina
