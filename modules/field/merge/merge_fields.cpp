#include "field/merge/merge_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <tbb/parallel_for.h>

#include "core/error.h"
#include "core/numbers.h"
#include "field/store/face_block.h"

namespace patina {
namespace {

int blockOf(double node) {
  return static_cast<int>(std::floor(node / kBlockSide));
}

} // namespace

void BlockBox::extend(const BlockBox& other) {
  if (other.isEmpty()) return;
  if (isEmpty()) {
    *this = other;
    return;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = std::min(low[a], other.low[a]);
    high[a] = std::max(high[a], other.high[a]);
  }
}

BlockBox blocksAround(const BlockLattice& lattice, const Box3& box, double band) {
  constexpr double kSlack = 1e-6; // absorbs the rounding of the division
  BlockBox blocks;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double low = (box.min()[axis] - lattice.anchor[axis]) / lattice.voxel - band;
    const double high = (box.max()[axis] - lattice.anchor[axis]) / lattice.voxel + band;
    if (!(high - low < kMaxNodes && std::abs(low) < 1e9))
      throw Error("field: an object needs " + formatNumber(std::ceil(high - low)) + " voxels of " +
                  formatLength(lattice.voxel) + " on a side; the maximum is " +
                  std::to_string(kMaxNodes - 1) + "; choose a larger voxel");
    blocks.low[a] = blockOf(std::floor(low + kSlack));
    blocks.high[a] = blockOf(std::ceil(high - kSlack)) + 1;
  }
  return blocks;
}

FieldGrid gridOf(const BlockLattice& lattice, const BlockBox& blocks) {
  FieldGrid grid;
  grid.voxel = lattice.voxel;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    grid.origin[axis] = lattice.anchor[axis] + lattice.voxel * kBlockSide * blocks.low[a];
    grid.nodes[a] = kBlockSide * (blocks.high[a] - blocks.low[a]);
    if (grid.nodes[a] > kMaxNodes)
      throw Error("field: the scene needs " + std::to_string(grid.nodes[a]) + " voxels of " +
                  formatLength(lattice.voxel) + " on a side; the maximum is " +
                  std::to_string(kMaxNodes) + "; choose a larger voxel or move objects closer");
  }
  return grid;
}

std::array<int, 3> firstBlock(const BlockLattice& lattice, const FieldGrid& grid) {
  std::array<int, 3> first{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    first[a] = static_cast<int>(
        std::lround((grid.origin[axis] - lattice.anchor[axis]) / (kBlockSide * lattice.voxel)));
  }
  return first;
}

namespace {

std::size_t linear(const Index3& at, const Index3& n) {
  return static_cast<std::size_t>((at[2] * n[1] + at[1]) * n[0] + at[0]);
}

Index3 minus(const Index3& a, const Index3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class Visit> void forBox(const Index3& low, const Index3& high, const Visit& visit) {
  for (int z = low[2]; z < high[2]; ++z)
    for (int y = low[1]; y < high[1]; ++y)
      for (int x = low[0]; x < high[0]; ++x) visit(Index3{x, y, z});
}

// Blocks that the parts store at one position.
struct Share {
  std::int32_t part, slot;
};
struct Place {
  std::vector<Share> shares; // ascending parts
  bool inside = false;       // a part is deeper than the band there
};

std::vector<Place> places(std::span<const FieldPart> parts, const SurfaceField& merged,
                          const Index3& low) {
  std::vector<Place> result(merged.block_index.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const SurfaceField& field = *parts[p].field;
    const Index3 shift = minus(parts[p].first_block, low);
    forBox({0, 0, 0}, field.blocks, [&](const Index3& b) {
      const std::int32_t slot = field.slotOf(b[0], b[1], b[2]);
      if (slot == SurfaceField::kOutside) return;
      Place& place =
          result[linear({b[0] + shift[0], b[1] + shift[1], b[2] + shift[2]}, merged.blocks)];
      if (slot == SurfaceField::kInside)
        place.inside = true;
      else
        place.shares.push_back({static_cast<std::int32_t>(p), slot});
    });
  }
  return result;
}

struct Block {
  std::shared_ptr<const DistanceBlock> distance; // null: entirely deeper than the band
  std::shared_ptr<const FaceBlock> face;
};

Block shared(const FieldPart& part, std::int32_t slot) {
  const auto s = static_cast<std::size_t>(slot);
  Block block{part.field->distance[s], nullptr};
  if (part.field->face.empty()) return block;
  block.face = part.first_face == 0
                   ? part.field->face[s]
                   : std::make_shared<const FaceBlock>(*part.field->face[s], part.first_face);
  return block;
}

// The minimum also works for +-kBackground, which lie beyond every stored value.
Block least(std::span<const FieldPart> parts, const std::vector<Share>& shares, bool with_faces) {
  std::vector<DistanceNodes> held(shares.size());
  for (std::size_t s = 0; s < shares.size(); ++s)
    parts[static_cast<std::size_t>(shares[s].part)]
        .field->distance[static_cast<std::size_t>(shares[s].slot)]
        ->unpack(held[s]);
  DistanceNodes distance;
  FaceNodes faces;
  bool any = false;
  for (std::size_t n = 0; n < kBlockNodes; ++n) {
    float phi = std::numeric_limits<float>::infinity();
    const Share* owner = nullptr;
    for (std::size_t s = 0; s < shares.size(); ++s)
      if (held[s].phi[n] < phi) {
        phi = held[s].phi[n];
        owner = &shares[s];
      }
    distance.phi[n] = phi;
    const bool stored = std::abs(phi) < kBackground;
    any = any || stored;
    if (!with_faces) continue;
    faces.face[n] = -1;
    if (!stored) continue;
    const FieldPart& part = parts[static_cast<std::size_t>(owner->part)];
    const std::int32_t face = part.field->face[static_cast<std::size_t>(owner->slot)]->at(n);
    if (face >= 0) faces.face[n] = face + part.first_face;
  }
  if (!any) return {};
  return {std::make_shared<const DistanceBlock>(distance),
          with_faces ? std::make_shared<const FaceBlock>(faces) : nullptr};
}

// Returns a lower bound of the distance [voxel] from a point of the part's grid to its surface.
double beyondBox(const SurfaceField& field, const Vec3& q) {
  Vec3 out;
  for (int a = 0; a < 3; ++a) {
    const double last = field.grid.nodes[static_cast<std::size_t>(a)] - 1;
    out[a] = std::max({field.band - q[a], q[a] - (last - field.band), 0.0});
  }
  return out.norm();
}

CoarseNode minCoarse(std::span<const FieldPart> parts, const Index3& at) {
  CoarseNode node{std::numeric_limits<float>::infinity(), 0, 0, 0};
  float bound = node.phi;
  for (const FieldPart& part : parts) {
    const SurfaceField& field = *part.field;
    const Index3 in = minus(at, part.first_block);
    const Index3 corners{field.blocks[0] + 1, field.blocks[1] + 1, field.blocks[2] + 1};
    if (BlockBox{{0, 0, 0}, corners}.contains(in)) {
      const CoarseNode& own = field.coarse[linear(in, corners)];
      if (own.phi < node.phi) node = own;
    } else {
      bound = std::min(
          bound, static_cast<float>(beyondBox(field, kBlockSide * Vec3(in[0], in[1], in[2]))));
    }
  }
  node.phi = std::min(node.phi, bound);
  return node;
}

void checkParts(std::span<const FieldPart> parts, const BlockLattice& lattice) {
  if (parts.empty()) throw std::invalid_argument("mergeFields: no part");
  for (const FieldPart& part : parts)
    if (!part.field || part.field->grid.voxel != lattice.voxel ||
        part.field->band != parts[0].field->band)
      throw std::invalid_argument("mergeFields: the parts differ in voxel or band");
}

} // namespace

BlockBox FieldPart::blocks() const {
  BlockBox box{first_block, first_block};
  for (std::size_t a = 0; a < 3; ++a) box.high[a] += field->blocks[a];
  return box;
}

SurfaceField mergeFields(std::span<const FieldPart> parts, const BlockLattice& lattice) {
  checkParts(parts, lattice);
  BlockBox box;
  bool with_faces = true, with_coarse = true;
  for (const FieldPart& part : parts) {
    box.extend(part.blocks());
    with_faces = with_faces && part.field->face.size() == part.field->blockCount();
    with_coarse = with_coarse && !part.field->coarse.empty();
  }
  SurfaceField merged;
  merged.grid = gridOf(lattice, box);
  merged.band = parts[0].field->band;
  merged.blocks = minus(box.high, box.low);
  merged.block_index.assign(linear({0, 0, merged.blocks[2]}, merged.blocks),
                            SurfaceField::kOutside);

  const std::vector<Place> all = places(parts, merged, box.low);
  std::vector<Block> blocks(all.size());
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    const Place& place = all[i];
    if (place.inside || place.shares.empty()) return;
    const Share& first = place.shares[0];
    blocks[i] = place.shares.size() == 1
                    ? shared(parts[static_cast<std::size_t>(first.part)], first.slot)
                    : least(parts, place.shares, with_faces);
  });
  std::size_t i = 0;
  forBox({0, 0, 0}, merged.blocks, [&](const Index3& at) {
    Block& block = blocks[i];
    if (block.distance) {
      merged.block_index[i] = static_cast<std::int32_t>(merged.block_at.size());
      merged.block_at.push_back(at);
      merged.distance.push_back(std::move(block.distance));
      if (with_faces) merged.face.push_back(std::move(block.face));
    } else if (all[i].inside || !all[i].shares.empty()) {
      merged.block_index[i] = SurfaceField::kInside;
    }
    ++i;
  });

  if (!with_coarse) return merged;
  const Index3 corners{merged.blocks[0] + 1, merged.blocks[1] + 1, merged.blocks[2] + 1};
  merged.coarse.resize(linear({0, 0, corners[2]}, corners));
  tbb::parallel_for(0, corners[2], [&](int z) {
    forBox({0, 0, z}, {corners[0], corners[1], z + 1}, [&](const Index3& at) {
      merged.coarse[linear(at, corners)] =
          minCoarse(parts, {at[0] + box.low[0], at[1] + box.low[1], at[2] + box.low[2]});
    });
  });
  return merged;
}

double phiOfPart(const FieldPart& part, const NodeReader& nodes, const Vec3& q) {
  constexpr double kCompleteTo = 1.75; // [voxel] from the band's end; beyond it cells are complete
  const SurfaceField& field = *part.field;
  const Vec3 in =
      q - kBlockSide * Vec3(part.first_block[0], part.first_block[1], part.first_block[2]);
  Index3 cell{}, corner{};
  const double least = std::max(field.band - kCompleteTo, 0.0);
  for (std::size_t a = 0; a < 3; ++a) {
    const double x = in[static_cast<Eigen::Index>(a)];
    if (!(x >= 0 && x <= field.grid.nodes[a] - 1)) return std::max(beyondBox(field, in), least);
    cell[a] = std::min(static_cast<int>(x), field.grid.nodes[a] - 2);
    corner[a] = static_cast<int>(std::lround(x / kBlockSide));
  }
  double sum = 0, sign = 1; // sign of any node: a surface between two would be in the band
  bool complete = true;
  for (int c = 0; c < 8; ++c) {
    const Vec3 node(cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2));
    const auto phi = static_cast<double>(nodes.phiAt(
        static_cast<int>(node[0]), static_cast<int>(node[1]), static_cast<int>(node[2])));
    complete = complete && std::abs(phi) < static_cast<double>(kBackground);
    sum += phi * (Vec3::Ones() - (in - node).cwiseAbs()).prod();
    sign = std::copysign(1, phi);
  }
  if (complete) return sum;
  if (field.coarse.empty()) return sign * least;
  const Index3 corners{field.blocks[0] + 1, field.blocks[1] + 1, field.blocks[2] + 1};
  const auto known = static_cast<double>(std::abs(field.coarse[linear(corner, corners)].phi));
  const double away = (in - kBlockSide * Vec3(corner[0], corner[1], corner[2])).norm();
  return sign * std::max(known - away, least);
}

} // namespace patina
