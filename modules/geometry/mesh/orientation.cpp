#include "geometry/mesh/orientation.h"

#include <algorithm>
#include <numeric>

#include "geometry/mesh/edge_uses.h"

namespace patina {
namespace {

// Faces joined over edges, each with a flag: turned relative to the lowest face of its part.
class Parts {
 public:
  explicit Parts(std::size_t faces) : link_(faces), one_sided_(faces), open_(faces) {
    for (std::size_t f = 0; f < faces; ++f) link_[f] = {static_cast<std::int32_t>(f), false};
  }
  struct Link {
    std::int32_t root;
    bool turned;
  };
  Link find(std::int32_t face) {
    Link to = link_[index(face)];
    bool turned = false;
    while (to.root != face) {
      const Link next = link_[index(to.root)];
      link_[index(face)] = {next.root, to.turned != next.turned}; // halves the path
      turned = turned != link_[index(face)].turned;
      face = next.root;
      to = link_[index(face)];
    }
    return {face, turned};
  }
  void join(std::int32_t f, std::int32_t g, bool opposed) {
    const Link a = find(f), b = find(g);
    const bool turned = (a.turned != b.turned) != opposed;
    any_joined_ = true;
    if (a.root == b.root) {
      if (turned) one_sided_[index(a.root)] = 1;
      return;
    }
    const std::int32_t low = std::min(a.root, b.root), high = std::max(a.root, b.root);
    link_[index(high)] = {low, turned};
    one_sided_[index(low)] |= one_sided_[index(high)];
    open_[index(low)] |= open_[index(high)];
  }
  void markOpen(std::int32_t face) { open_[index(find(face).root)] = 1; }
  bool anyJoined() const { return any_joined_; }
  bool oneSided(std::int32_t root) const { return one_sided_[index(root)] != 0; }
  bool open(std::int32_t root) const { return open_[index(root)] != 0; }

 private:
  std::vector<Link> link_;
  std::vector<std::uint8_t> one_sided_, open_; // indexed by root
  bool any_joined_ = false;
};

Parts connectedParts(const std::vector<Triangle>& triangles) {
  Parts parts(triangles.size());
  const auto rises = [&](const EdgeUse& use) {
    return triangles[index(use.face)][index(use.edge)] == use.low;
  };
  forEachEdge(
      triangles, [](std::size_t) { return true; },
      [&](const EdgeUse* first, const EdgeUse* last) {
        if (last - first == 2)
          parts.join(first->face, first[1].face, rises(first[0]) == rises(first[1]));
        else
          for (auto use = first; use != last; ++use) parts.markOpen(use->face);
      });
  return parts;
}

struct TurnedPart {
  double area = 0, turned_area = 0; // all faces; faces that find() calls turned
  double volume = 0;                // volume after turning
  Box3 box;
  bool turn_others = false; // the faces not called turned are fewer: turn those
  bool turn_all = false;
};

// Marks closed parts whose orientation differs from most of the volume.
void compareClosed(std::vector<TurnedPart*> closed) {
  constexpr std::size_t kMaxParts = 1U << 14; // The comparison is quadratic.
  if (closed.size() < 2 || closed.size() > kMaxParts) return;
  const auto size = [](const TurnedPart* p) { return p->box.volume(); };
  std::stable_sort(closed.begin(), closed.end(),
                   [&](const TurnedPart* a, const TurnedPart* b) { return size(a) > size(b); });
  std::vector<TurnedPart*> outer;
  std::vector<TurnedPart*> holder(closed.size());
  double volume = 0;
  for (std::size_t i = 0; i < closed.size(); ++i) {
    for (TurnedPart* other : outer) // The last one that contains it is the smallest.
      if (size(other) > size(closed[i]) && other->box.contains(closed[i]->box)) holder[i] = other;
    if (holder[i]) continue;
    outer.push_back(closed[i]);
    volume += closed[i]->volume;
  }
  for (TurnedPart* part : outer) part->turn_all = part->volume * (volume < 0 ? -1 : 1) < 0;
  for (std::size_t i = 0; i < closed.size(); ++i)
    if (holder[i]) closed[i]->turn_all = holder[i]->turn_all;
}

} // namespace

std::vector<std::int32_t> misorientedTriangles(const TriangleMesh& mesh,
                                               const std::vector<Triangle>& welded) {
  Parts links = connectedParts(welded);
  if (!links.anyJoined()) return {}; // loose triangles
  const std::size_t faces = mesh.triangles.size();
  std::vector<Parts::Link> link(faces);
  std::vector<std::int32_t> part_of(faces, -1); // indexed by root
  std::vector<TurnedPart> parts;
  for (std::size_t f = 0; f < faces; ++f) {
    link[f] = links.find(static_cast<std::int32_t>(f));
    if (index(link[f].root) != f) continue; // a root is its part's lowest face
    part_of[f] = static_cast<std::int32_t>(parts.size());
    parts.emplace_back();
  }
  const auto partOf = [&](std::size_t f) -> TurnedPart& {
    return parts[index(part_of[index(link[f].root)])];
  };
  const Vec3 origin = mesh.positions.empty() ? Vec3(Vec3::Zero()) : mesh.positions.front();
  for (std::size_t f = 0; f < faces; ++f) {
    const Vec3 a = mesh.corner(f, 0) - origin, b = mesh.corner(f, 1) - origin,
               c = mesh.corner(f, 2) - origin;
    const Vec3 normal = (b - a).cross(c - a);
    const double area = normal.norm();
    TurnedPart& part = partOf(f);
    part.area += area;
    if (link[f].turned) part.turned_area += area;
    part.volume += (link[f].turned ? -1 : 1) * a.dot(normal);
    for (const Vec3& p : {a, b, c}) part.box.extend(p);
  }
  std::vector<TurnedPart*> closed;
  for (std::size_t f = 0; f < faces; ++f) {
    if (index(link[f].root) != f) continue;
    TurnedPart& part = partOf(f);
    part.turn_others = 2 * part.turned_area > part.area;
    if (part.turn_others) part.volume = -part.volume;
    const auto root = static_cast<std::int32_t>(f);
    if (!links.open(root) && !links.oneSided(root)) closed.push_back(&part);
  }
  compareClosed(std::move(closed));
  std::vector<std::int32_t> result;
  for (std::size_t f = 0; f < faces; ++f) {
    if (links.oneSided(link[f].root)) continue;
    const TurnedPart& part = partOf(f);
    if ((link[f].turned != part.turn_others) != part.turn_all)
      result.push_back(static_cast<std::int32_t>(f));
  }
  return result;
}

} // namespace patina
