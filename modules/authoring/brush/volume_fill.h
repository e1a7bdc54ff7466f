// Which faces a brush reaches, found without looking at the others (K15).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "authoring/brush/paint_surface.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {

// Holds marks for every face and vertex, made once, so that a fill costs what it finds. One thread.
class VolumeFill {
 public:
  explicit VolumeFill(std::shared_ptr<const PaintSurface> surface);

  // The surface's point nearest to p, as far as the faces that the nodes about p name and a walk
  // downhill from them tell. Nullopt beyond the field's band.
  std::optional<ClosestPoint> foot(const Vec3& p) const;

  // Where the way from the tip to p goes through a face that the nodes of p's cell name, the place
  // nearest to p; two voxels beyond p where there is none before (K15). Nullopt: none there either.
  std::optional<ClosestPoint> pierced(const Vec3& tip, const Vec3& p) const;

  // Faces of which some point is within `radius` of the centre: those connected with `seed` inside
  // the sphere, and with any face that a node inside it names, so that other objects and parts are
  // found too. Parts between nodes may be missed; what is returned is within reach. Where `front`
  // is not zero, only faces whose normal has a positive part along it, or that have no area. By
  // object; valid until the next fill.
  std::span<const std::int32_t> fill(const Vec3& centre, double radius, std::int32_t seed,
                                     const Vec3& front);

 private:
  std::vector<std::int32_t> facesOfCell(const Vec3& p) const; // that its nodes name
  void nextEpoch();
  void seedFromNodes();
  void visit(std::int32_t face);
  void visitFan(std::int32_t vertex);
  bool reaches(std::int32_t face) const;

  std::shared_ptr<const PaintSurface> surface_;
  std::vector<std::uint32_t> face_mark_, vertex_mark_; // == epoch_: seen in this fill
  std::uint32_t epoch_ = 0;
  std::vector<std::int32_t> found_, stack_;
  Vec3 centre_ = Vec3::Zero(), front_ = Vec3::Zero();
  double radius_ = 0;
};

} // namespace patina
