#include "app/gui/control/touching.h"

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

Vec3 touching(const CompiledScene& scene, const Vec3& surface) {
  return surface + skinOf(scene.scene.haptics) * normalAt(scene, surface);
}

} // namespace patina
