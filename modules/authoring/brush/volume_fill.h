// Finds the faces within the brush in time proportional to their number (K15).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "authoring/brush/paint_surface.h"
#include "geometry/tree/triangle_tree.h"

namespace patina {

// Holds marks for every face and vertex, made once. One thread.
class VolumeFill {
 public:
  explicit VolumeFill(std::shared_ptr<const PaintSurface> surface);

  // Returns the surface point nearest to p, starting from the nearest faces of the nodes about p
  // and descending over neighbours. Nullopt outside the field's band.
  std::optional<ClosestPoint> foot(const Vec3& p) const;

  // Returns where the segment from the tip to p crosses one of the nearest faces of p's cell: the
  // crossing nearest to p, or one up to two voxels beyond p (K15), or nullopt.
  std::optional<ClosestPoint> segmentHit(const Vec3& tip, const Vec3& p) const;

  // Returns the faces with a point within `radius` of the centre that are connected inside the
  // sphere with `seed` or with the nearest face of a node inside, which finds other objects and
  // parts too. Parts between nodes may be missed. If `front` is not zero, only faces whose normal
  // has a positive component along it, or without area. Sorted by object; valid until the next
  // fill.
  std::span<const std::int32_t> fill(const Vec3& centre, double radius, std::int32_t seed,
                                     const Vec3& front);

 private:
  std::vector<std::int32_t> facesOfCell(const Vec3& p) const; // nearest faces of its nodes
  void nextEpoch();
  void seedFromNodes();
  void visit(std::int32_t face);
  void visitFan(std::int32_t vertex);
  bool reaches(std::int32_t face) const;

  std::shared_ptr<const PaintSurface> surface_;
  std::vector<std::uint32_t> face_mark_, vertex_mark_; // == epoch_: visited in this fill
  std::uint32_t epoch_ = 0;
  std::vector<std::int32_t> found_, stack_;
  Vec3 centre_ = Vec3::Zero(), front_ = Vec3::Zero();
  double radius_ = 0;
};

} // namespace patina
