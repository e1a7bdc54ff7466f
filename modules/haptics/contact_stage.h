// Finds the frictionless virtual contact point (K03, K05, K06).
#pragma once

#include <memory>

#include "field/field_sampler.h"
#include "haptics/stage.h"
#include "haptics/thin_part.h"

namespace patina {

// Sets touching, normal, candidate, vcp (= candidate), depth and surface.
//
// Deeper than the band the first direction comes from the coarse nodes; the ray still ends on the
// surface, and the normals found there improve it. A tip that has passed through the surface
// between two ticks (swept test), or past the middle of a part so that the direction turned by more
// than 90 degrees, is held: the VCP walks on the side where it entered, until
//  - the tip is in front of the tangent plane there, or
//  - the tip is inside and the field's own direction is within 60 degrees of the held one, or
//  - the tip is outside and held deeper than a quarter of the grid's longest side (inside there is
//    no such limit: letting go there would turn the force around), or the surface is lost.
// About the middle of a deep part, where points on opposite sides are about as near, the VCP is the
// point of the surface nearest to the tip (F9), and from then on straight ahead of the tip.
// Where the way of finding the VCP changes in contact, the difference fades over some 5 ms, but by
// no more than five grid sides a second.
class ContactStage final : public ForceStage {
 public:
  // iso [m]: the tip's radius, plus the offset (K12). history = false is the paper's own form: no
  // swept test, and past the middle of a part the force turns round. Throws std::invalid_argument
  // without a sample layer.
  ContactStage(std::shared_ptr<const SurfaceField> field, Sampler sampler, double iso,
               bool history = true);

  void apply(Contact& contact, ContactMemory& memory) const noexcept override;
  std::string_view name() const noexcept override { return "contact"; }

 private:
  struct Found {
    Vec3 normal = Vec3::Zero();
    double depth = 0; // voxels
    ContactMode mode = ContactMode::ray;
  };
  bool hold(const Vec3& q, const GridSample& sample, const Vec3& direction,
            const ContactMemory& memory, Found& found) const noexcept;
  bool follow(const Vec3& q, const SurfaceContact& from, double limit, double reach,
              Found& found) const noexcept;
  void alongRay(const Vec3& q, const GridSample& sample, const Vec3& direction, Contact& contact,
                Found& found) const noexcept;
  bool towardsFoot(const Vec3& q, const Vec3& near, Found& found) const noexcept;
  void refine(const Vec3& q, Contact& contact, Found& found) const noexcept;
  Vec3 toGrid(const Vec3& p) const noexcept { return per_voxel_ * (p - sampler_.grid().origin); }
  void finish(const Found& found, Contact& contact, ContactMemory& memory) const noexcept;

  std::shared_ptr<const SurfaceField> field_;
  FieldSampler sampler_;
  double voxel_;
  double per_voxel_;  // [1/m]: a product is quicker than grid().toGrid()'s division
  double iso_;        // voxels
  double hold_limit_; // voxels
  bool history_;
};

} // namespace patina
