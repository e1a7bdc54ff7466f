#include "app/gui/control/touching.h"

#include <algorithm>

#include "field/sampling/field_sampler.h"

namespace patina {

Vec3 normalAt(const CompiledScene& scene, const Vec3& surface) {
  const Vec3 gradient = FieldSampler(*scene.built.field, scene.scene.sampler).at(surface).gradient;
  const double size = gradient.norm();
  return size > 1e-9 ? Vec3(gradient / size) : Vec3::UnitZ();
}

double skinOf(const HapticProperties& haptics) {
  return haptics.tip_radius.value_or(0) + haptics.offset.value_or(0);
}

double depthWithin(const CompiledScene& scene, const Vec3& surface, double depth) {
  const FieldSampler sampler(*scene.built.field, scene.scene.sampler);
  const Vec3 inwards = -normalAt(scene, surface);
  const double step = 0.5 * scene.built.field->grid.voxel;
  // To the middle the surface is as far as was gone.
  double within = step;
  while (within < depth && sampler.at(surface + (within + step) * inwards).phi < -0.8 * within)
    within += step;
  return std::min(depth, within);
}

Vec3 touching(const CompiledScene& scene, const Vec3& surface) {
  return surface + skinOf(scene.scene.haptics) * normalAt(scene, surface);
}

} // namespace patina
