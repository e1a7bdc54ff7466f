#include "field/construction/thickened_sheet.h"

#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "field/signs/sign_components.h"
#include "field/signs/sign_slivers.h"
#include "geometry/sides/pseudonormal_side.h"

namespace patina {
namespace {

constexpr int kHalvings = 10; // 1e-3 voxel
constexpr float kClose = 1;   // [voxel]

struct CapEdge {
  Index3 node;
  int axis = 0;
  std::int32_t face = -1; // nearest face of the end inside the sheet
  bool ahead = false;     // the inner end is the edge's far end
  bool doubtful = false;
  Vec3 cut = Vec3::Zero();
};

class Caps {
 public:
  Caps(const FieldBuilder& builder, const TriangleMesh& mesh, const TriangleTree& tree,
       const OpenParts& open, double thickness, const Progress& progress)
      : builder_(builder), tree_(tree), open_(open), front_(mesh, open.open, open.seams),
        progress_(progress), reach_(thickness * builder.field.grid.voxel) {}

  SheetCaps run() {
    std::vector<std::vector<CapEdge>> found(builder_.distance.size());
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t slot) {
      if (progress_.cancelled()) return;
      found[slot] = edgesOf(slot);
      for (CapEdge& edge : found[slot]) edge.cut = cutOf(edge);
    });
    progress_.throwIfCancelled();
    for (const auto& edges : found)
      for (const CapEdge& edge : edges)
        for (int corner = 0; corner < 4; ++corner) {
          const std::size_t at = cornerOf(edge, corner);
          caps_.mesh.positions[at] += edge.cut;
          ++cuts_[at];
        }
    for (std::size_t i = 0; i < cuts_.size(); ++i) caps_.mesh.positions[i] /= cuts_[i];
    for (const auto& edges : found)
      for (const CapEdge& edge : edges) {
        close(edge);
        caps_.doubtful += edge.doubtful;
      }
    return std::move(caps_);
  }

 private:
  struct Node {
    float phi = kBackground;
    std::int32_t face = -1;
  };
  using Unpacked = std::map<std::size_t, std::array<float, kBlockNodes>>; // distances of each slot

  Node nodeAt(const Index3& at, Unpacked& known) const {
    const SurfaceField::NodeAddress place = builder_.field.placeOf(at[0], at[1], at[2]);
    if (place.slot < 0) return {backgroundOf(place.slot), -1};
    const auto slot = static_cast<std::size_t>(place.slot);
    auto phi = known.find(slot);
    if (phi == known.end()) phi = known.emplace(slot, phiOf(builder_, slot)).first;
    return {phi->second[place.index], builder_.face[slot]->at(place.index)};
  }

  bool inPlate(const Node& node) const {
    return node.phi < 0 && node.face >= 0 && open_.open[static_cast<std::size_t>(node.face)] != 0;
  }

  std::vector<CapEdge> edgesOf(std::size_t slot) const {
    std::vector<CapEdge> edges;
    Unpacked known; // this block and its neighbours
    for (std::size_t n = 0; n < kBlockNodes; ++n) {
      const Index3 at = signs::nodeAt(builder_, static_cast<std::int32_t>(slot), n);
      const Node node = nodeAt(at, known);
      for (int axis = 0; axis < 3; ++axis) {
        for (const int way : {1, -1}) {
          if (!inPlate(node)) continue;
          Index3 to = at;
          to[static_cast<std::size_t>(axis)] += way;
          const Node other = nodeAt(to, known);
          if (other.phi < 0 || std::abs(node.phi) + std::abs(other.phi) <= 1 + signs::kMargin)
            continue;
          edges.push_back(
              {way > 0 ? at : to, axis, node.face,
               way<0, node.phi> - kClose && other.phi < kClose && isInFront(to, other.face),
               Vec3::Zero()});
        }
      }
    }
    return edges;
  }

  bool isInFront(const Index3& at, std::int32_t face) const {
    return open_.open[static_cast<std::size_t>(face)] != 0 &&
           front_.at(builder_.field.grid.toWorld(Vec3(at[0], at[1], at[2])), face) == Side::front;
  }

  bool insideAt(const Vec3& p, std::int32_t warm) const {
    const auto near = tree_.closestPointWithin(p, reach_, warm);
    return near && near->distance < reach_ &&
           open_.open[static_cast<std::size_t>(near->surface.face)] != 0 &&
           front_.at(p, near->surface.face) == Side::back;
  }

  Vec3 cutOf(const CapEdge& edge) const {
    const FieldGrid& grid = builder_.field.grid;
    Vec3 low(edge.node[0], edge.node[1], edge.node[2]), high = low;
    high[edge.axis] += 1;
    if (edge.ahead) std::swap(low, high);
    Vec3 in = grid.toWorld(low), out = grid.toWorld(high);
    for (int i = 0; i < kHalvings; ++i) {
      const Vec3 middle = 0.5 * (in + out);
      (insideAt(middle, edge.face) ? in : out) = middle;
    }
    return 0.5 * (in + out);
  }

  // Returns the corner in one of the four cells round an edge.
  std::size_t cornerOf(const CapEdge& edge, int corner) {
    Index3 cell = edge.node;
    const auto b = static_cast<std::size_t>((edge.axis + 1) % 3),
               c = static_cast<std::size_t>((edge.axis + 2) % 3);
    if (corner == 0 || corner == 3) --cell[b];
    if (corner == 0 || corner == 1) --cell[c];
    std::uint64_t key = 0;
    for (const int i : cell) key = key << 21 | static_cast<std::uint64_t>(i + 1);
    const auto [found, fresh] = corner_of_.try_emplace(key, cuts_.size());
    if (fresh) {
      cuts_.push_back(0);
      caps_.mesh.positions.push_back(Vec3::Zero());
    }
    return found->second;
  }

  void close(const CapEdge& edge) {
    std::array<std::int32_t, 4> q{};
    for (int corner = 0; corner < 4; ++corner)
      q[static_cast<std::size_t>(corner)] = static_cast<std::int32_t>(cornerOf(edge, corner));
    for (const Triangle& t : {Triangle{q[0], q[1], q[2]}, Triangle{q[0], q[2], q[3]}}) {
      caps_.mesh.triangles.push_back(t);
      caps_.face.push_back(edge.face);
    }
  }

  const FieldBuilder& builder_;
  const TriangleTree& tree_;
  const OpenParts& open_;
  const PseudonormalSide front_;
  const Progress& progress_;
  const double reach_; // [m]
  SheetCaps caps_;
  std::vector<double> cuts_; // position of the cut on each cap edge
  std::unordered_map<std::uint64_t, std::size_t> corner_of_;
};

} // namespace

SheetCaps sheetCaps(const FieldBuilder& builder, const TriangleMesh& mesh, const TriangleTree& tree,
                    const OpenParts& open, double thickness, const Progress& progress) {
  return Caps(builder, mesh, tree, open, thickness, progress).run();
}

void copySigns(FieldBuilder& builder, const FieldBuilder& like) {
  SurfaceField& field = builder.field;
  const std::vector<std::int32_t>& top = like.field.block_index;
  for (std::size_t i = 0; i < field.block_index.size(); ++i)
    if (field.block_index[i] < 0)
      field.block_index[i] = top[i] >= 0 && phiAt(like, top[i], 0) < 0 ? SurfaceField::kInside
                             : top[i] >= 0                             ? SurfaceField::kOutside
                                                                       : top[i];
  tbb::parallel_for(std::size_t{0}, field.block_index.size(), [&](std::size_t i) {
    if (field.block_index[i] < 0) return;
    const auto slot = static_cast<std::size_t>(field.block_index[i]);
    auto phi = phiOf(builder, slot);
    const auto signs = top[i] < 0 ? phi : phiOf(like, static_cast<std::size_t>(top[i]));
    for (std::size_t n = 0; n < phi.size(); ++n)
      if (top[i] < 0 ? top[i] == SurfaceField::kInside : signs[n] < 0) phi[n] = -phi[n];
    setPhi(builder, slot, phi);
  });
}

} // namespace patina
