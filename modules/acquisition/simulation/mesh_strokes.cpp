#include "acquisition/simulation/mesh_strokes.h"

#include <cmath>
#include <memory>

#include "geometry/tree/triangle_tree.h"

namespace patina {
namespace {

constexpr double kReach = 1e-3; // the surface must continue within this distance of the path [m]

class Heights {
 public:
  explicit Heights(const TriangleMesh& mesh) : tree_(mesh), box_(bounds(mesh)) {}

  const Box3& box() const { return box_; }
  double at(const Vec2& place) const {
    const std::optional<RayHit> hit = hitAt(place);
    return hit ? top() - hit->t : box_.min().z();
  }
  // Outward normal of the surface's slope within kReach, which changes continuously over facets.
  Vec3 normalAt(const Vec2& place) const {
    const Vec2 x(kReach, 0), y(0, kReach);
    return Vec3(at(place - x) - at(place + x), at(place - y) - at(place + y), 2 * kReach)
        .normalized();
  }
  bool reachable(const Vec2& place) const {
    const double here = at(place);
    for (const Vec2& aside : {Vec2(kReach, 0), Vec2(-kReach, 0), Vec2(0, kReach), Vec2(0, -kReach)})
      if (!hitAt(place + aside) || std::abs(at(place + aside) - here) > kReach) return false;
    return hitAt(place).has_value();
  }

 private:
  double top() const { return box_.max().z() + kReach; }
  std::optional<RayHit> hitAt(const Vec2& place) const {
    return tree_.firstHit({place.x(), place.y(), top()}, -Vec3::UnitZ(),
                          2 * kReach + box_.sizes().z());
  }

  TriangleTree tree_;
  Box3 box_;
};

} // namespace

SimulatedHand scanPathsOver(const TriangleMesh& mesh, std::uint32_t seed, double seconds,
                            double speed) {
  const auto heights = std::make_shared<const Heights>(mesh);
  StrokeArea area;
  area.low = heights->box().min().head<2>();
  area.high = heights->box().max().head<2>();
  area.reachable = [heights](const Vec2& place) { return heights->reachable(place); };
  SimulatedHand hand = strokes(seed, seconds, speed, area);
  hand.travel_height += heights->box().max().z();
  hand.relief = [heights](const Vec2& place) { return heights->at(place); };
  hand.normal = [heights](const Vec2& place) { return heights->normalAt(place); };
  return hand;
}

} // namespace patina
