// Ways to keep the same nodes in memory for Kim's blend of nodal gradients: what each costs in
// bytes, time and rounding.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/studies/field/field_candidates.h"
#include "field/store/surface_field.h"

namespace patina {

class FieldLayout {
 public:
  virtual ~FieldLayout() = default;
  virtual std::string name() const = 0;
  virtual std::size_t bytes() const = 0; // distance and gradient, top table included
  virtual CandidateSample atGrid(const Vec3& q) const noexcept = 0;
};

// The field needs its sample layer and must outlive the layouts.
std::vector<std::unique_ptr<FieldLayout>> fieldLayouts(const SurfaceField& field);

} // namespace patina
