#include "haptics/contact/offset_stage.h"

#include <cmath>

namespace patina {
namespace {

constexpr double kMinGradient = 0.1; // K05
constexpr double kLongestStep = 1;   // voxels; a longer one leaves the part that the tip is at

} // namespace

void OffsetStage::apply(Contact& contact, ContactMemory&) const noexcept {
  if (!contact.touching || contact.normal.isZero(0)) return;
  const FieldGrid& grid = sampler_.grid();
  const GridSample at = sampler_.atGrid(sampler_.toGrid(contact.surface));
  ++contact.samples;
  const double slope = at.gradient.norm();
  if (!(slope >= kMinGradient) || !(std::abs(at.phi) <= kLongestStep)) return;
  const Vec3 normal = at.gradient / slope;
  if (!(normal.dot(contact.normal) > 0)) return; // the other side of a thin part
  contact.surface -= grid.voxel * at.phi * normal;
}

} // namespace patina
