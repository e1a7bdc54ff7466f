#include "field/sampling/field_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/error.h"

namespace patina {

Sampler parseSampler(std::string_view text) {
  std::string choices;
  for (const SamplerEntry& entry : kSamplers) {
    if (text == entry.name) return entry.sampler;
    choices += (choices.empty() ? "" : " or ") + std::string(entry.name);
  }
  throw Error("unknown sampler '" + std::string(text) + "'; choose " + choices);
}

std::string_view name(Sampler sampler) {
  return kSamplers[static_cast<std::size_t>(sampler)].name;
}

namespace {

// Depth at which the transition ends; cells are complete down to band - sqrt(3).
constexpr double kHandOverEnd = 1.75, kHandOverWidth = 1;
// Highest start of the transition: even a narrow band keeps the values at the surface.
constexpr double kShallowestHandOver = -0.25;

// Dispersion range over which the exact derivative takes over.
constexpr double kCreaseWidth = 0.001;

} // namespace

FieldSampler::FieldSampler(const SurfaceField& field, Sampler sampler)
    : field_(&field), grid_(field.grid), per_voxel_(1 / field.grid.voxel), sampler_(sampler),
      last_node_(field.grid.nodes[0] - 1, field.grid.nodes[1] - 1, field.grid.nodes[2] - 1) {
  if (field.sample.size() != field.blockCount())
    throw std::invalid_argument("FieldSampler: the field has no sample layer; call withSamples()");
  transition_phi_ = field.coarse.empty() ? -std::numeric_limits<double>::infinity()
                                         : std::min(-(field.band - kHandOverEnd - kHandOverWidth),
                                                    kShallowestHandOver);
}

GridSample FieldSampler::atGrid(const Vec3& q) const noexcept {
  BandCell cell;
  if (!findCell(*field_, last_node_, q, cell)) [[unlikely]]
    return beyondBand(q);
  const Blend value = blended(cell);
  GridSample sample;
  sample.phi = static_cast<double>(value.sum[0] + value.taylor_half);
  sample.gradient = Vec3(value.sum[1], value.sum[2], value.sum[3]);
  sample.region = FieldRegion::band;
  if (sample.phi < transition_phi_) [[unlikely]]
    return blendToCoarse(q, sample);
  return sample;
}

namespace {

// The four nodes of a layer of a cell, x fastest, one quantity each.
struct Layer {
  Float4 phi, gx, gy, gz;
};
Layer layerAt(const SampleNode* node) {
  const Float4 a = load(node[0]), b = load(node[1]), c = load(node[kRow]), d = load(node[kRow + 1]);
  const Float4 ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5),
               ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7),
               cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5),
               cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  return {__builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5),
          __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7),
          __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5),
          __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7)};
}

float sumOf(Float4 value) {
  return (value[0] + value[1]) + (value[2] + value[3]);
}

} // namespace

// The gradient's length is not 1 on either side of a crease in baked relief.
void FieldSampler::applyExactGradient(const BandCell& cell, double exact_gradient_weight,
                                      SurfaceSample& sample) const noexcept {
  const float fx = cell.fx, fy = cell.fy, fz = cell.fz, ex = 1 - fx, ey = 1 - fy, ez = 1 - fz;
  const Layer low = layerAt(cell.node), high = layerAt(cell.node + kLayer);
  const Float4 weight = {ex * ey, fx * ey, ex * fy, fx * fy};
  const Float4 squares_low = low.gx * low.gx + low.gy * low.gy + low.gz * low.gz,
               squares_high = high.gx * high.gx + high.gy * high.gy + high.gz * high.gz;
  const float squares = sumOf(weight * (ez * squares_low + fz * squares_high));
  if (!(squares > 0)) return;
  sample.normal_dispersion =
      std::max(0.0, 1 - sample.gradient.squaredNorm() / static_cast<double>(squares));
  if (sample.normal_dispersion < kMaxNormalDispersion) sample.normal_dispersion = 0;
  const double share = std::clamp((sample.normal_dispersion - kMaxNormalDispersion) / kCreaseWidth,
                                  exact_gradient_weight, 1.0);
  if (share == 0) return;
  Float4 v_low = low.phi, v_high = high.phi;
  Vec3 derivative = Vec3::Zero();
  if (sampler_ == Sampler::high) {
    const Float4 half_x = {0.5F * fx, -0.5F * ex, 0.5F * fx, -0.5F * ex},
                 half_y = {0.5F * fy, 0.5F * fy, -0.5F * ey, -0.5F * ey};
    v_low += half_x * low.gx + half_y * low.gy + 0.5F * fz * low.gz;
    v_high += half_x * high.gx + half_y * high.gy - 0.5F * ez * high.gz;
    derivative = 0.5 * sample.gradient;
  }
  const Float4 v = ez * v_low + fz * v_high;
  derivative += Vec3((v[1] - v[0]) * ey + (v[3] - v[2]) * fy,
                     (v[2] - v[0]) * ex + (v[3] - v[1]) * fx, sumOf(weight * (v_high - v_low)));
  sample.gradient += share * (derivative - sample.gradient);
}

double FieldSampler::phiAtGrid(const Vec3& q) const noexcept {
  BandCell cell;
  if (!findCell(*field_, last_node_, q, cell)) [[unlikely]]
    return beyondBand(q).phi;
  const Blend value = blended(cell);
  const auto phi = static_cast<double>(value.sum[0] + value.taylor_half);
  if (phi < transition_phi_) [[unlikely]]
    return atGrid(q).phi;
  return phi;
}

namespace {

int clampedIndex(double value, int last) {
  return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(last)));
}

// Distance is 1-Lipschitz, so the nearest coarse node bounds it from below far from the surface.
double outsideBound(const SurfaceField& field, const Vec3& q) {
  const double least = std::max(0.0, field.band - kHandOverEnd);
  if (field.coarse.empty()) return least;
  std::array<int, 3> at{};
  Vec3 node;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    at[axis] = clampedIndex(std::round(q[a] / kBlockSide), field.blocks[axis]);
    node[a] = kBlockSide * at[axis];
  }
  const std::size_t index = static_cast<std::size_t>(
      (at[2] * (field.blocks[1] + 1) + at[1]) * (field.blocks[0] + 1) + at[0]);
  const double bound = static_cast<double>(field.coarse[index].phi) - (q - node).norm();
  return bound > least ? bound : least;
}

// Returns true if a point outside the band is inside, by its block's mark or its nearest node's
// sign.
bool isInside(const SurfaceField& field, const Vec3& q) {
  const auto& n = field.grid.nodes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = q[static_cast<Eigen::Index>(axis)];
    if (!(x >= 0 && x <= n[axis] - 1)) return false;
  }
  const auto i = static_cast<int>(std::lround(q[0])), j = static_cast<int>(std::lround(q[1])),
             k = static_cast<int>(std::lround(q[2]));
  const std::int32_t slot = field.slotOf(i / kBlockSide, j / kBlockSide, k / kBlockSide);
  if (slot < 0) return slot == SurfaceField::kInside;
  const int x = i % kBlockSide, y = j % kBlockSide, z = k % kBlockSide;
  return field.sample[static_cast<std::size_t>(slot)]
             ->node[static_cast<std::size_t>((z * kSampleSide + y) * kSampleSide + x)]
             .phi < 0;
}

} // namespace

GridSample FieldSampler::beyondBand(const Vec3& q) const noexcept {
  GridSample sample;
  if (q.hasNaN()) {
    sample.phi = std::numeric_limits<double>::infinity();
    sample.region = FieldRegion::invalid;
    return sample;
  }
  if (isInside(*field_, q)) return interiorSample(q);
  sample.phi = outsideBound(*field_, q);
  sample.region = FieldRegion::outside;
  return sample;
}

GridSample FieldSampler::interiorSample(const Vec3& q) const noexcept {
  GridSample sample;
  sample.region = FieldRegion::interior;
  if (field_->coarse.empty()) {
    sample.phi = -field_->band;
    return sample;
  }
  std::array<int, 3> at{};
  std::array<std::array<double, 2>, 3> weight{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double c = q[static_cast<Eigen::Index>(axis)] / kBlockSide;
    at[axis] = clampedIndex(c, field_->blocks[axis] - 1);
    const double f = std::clamp(c - at[axis], 0.0, 1.0);
    weight[axis] = {1 - f, f};
  }
  double phi = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::array<int, 3> step{static_cast<int>(corner & 1), static_cast<int>(corner >> 1 & 1),
                                  static_cast<int>(corner >> 2)};
    const std::size_t index = static_cast<std::size_t>(
        ((at[2] + step[2]) * (field_->blocks[1] + 1) + at[1] + step[1]) * (field_->blocks[0] + 1) +
        at[0] + step[0]);
    const CoarseNode& node = field_->coarse[index];
    const double w = weight[0][corner & 1] * weight[1][corner >> 1 & 1] * weight[2][corner >> 2];
    phi += w * static_cast<double>(node.phi);
    sample.gradient += w * Vec3(node.gx, node.gy, node.gz);
  }
  sample.phi = std::min(phi, -(field_->band - kHandOverEnd));
  return sample;
}

std::optional<FieldSampler::InteriorClosestPoints>
FieldSampler::interiorClosestPoints(const Vec3& q) const noexcept {
  constexpr float kOneDirection = 0.9F;  // shorter gradients mark several nearest points
  constexpr double kAsNear = kBlockSide; // [voxel], spacing of coarse nodes
  constexpr double kOpposed = -0.2;      // cosine
  if (field_->coarse.empty() || q.hasNaN()) return std::nullopt;
  std::array<int, 3> at{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    at[axis] =
        clampedIndex(q[static_cast<Eigen::Index>(axis)] / kBlockSide, field_->blocks[axis] - 1);
  std::array<Vec3, 8> way; // from q to each node's nearest surface point
  std::size_t count = 0, nearest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = at[0] + (corner & 1), y = at[1] + (corner >> 1 & 1), z = at[2] + (corner >> 2);
    const CoarseNode& node = field_->coarse[static_cast<std::size_t>(
        (z * (field_->blocks[1] + 1) + y) * (field_->blocks[0] + 1) + x)];
    if (!(node.phi < 0) ||
        node.gx * node.gx + node.gy * node.gy + node.gz * node.gz < kOneDirection * kOneDirection)
      continue;
    way[count] = kBlockSide * Vec3(x, y, z) -
                 static_cast<double>(node.phi) * Vec3(node.gx, node.gy, node.gz) - q;
    if (way[count].squaredNorm() < way[nearest].squaredNorm()) nearest = count;
    ++count;
  }
  if (count == 0) return std::nullopt;
  InteriorClosestPoints feet{q + way[nearest]};
  const double least = way[nearest].norm();
  for (std::size_t i = 0; i < count; ++i) {
    const double length = way[i].norm();
    feet.opposed = feet.opposed || (length < least + kAsNear &&
                                    way[i].dot(way[nearest]) < kOpposed * length * least);
  }
  return feet;
}

GridSample FieldSampler::blendToCoarse(const Vec3& q, const GridSample& sample) const noexcept {
  const double w = std::min((transition_phi_ - sample.phi) / kHandOverWidth, 1.0);
  GridSample deep = interiorSample(q);
  deep.phi += (1 - w) * (sample.phi - deep.phi);
  deep.gradient += (1 - w) * (sample.gradient - deep.gradient);
  return deep;
}

std::int32_t FieldSampler::faceNear(const Vec3& p) const noexcept {
  const Vec3 q = grid_.toGrid(p);
  const auto& n = grid_.nodes;
  std::array<int, 3> cell{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = q[static_cast<Eigen::Index>(axis)];
    if (!(x >= -1 && x <= n[axis])) return -1;
    cell[axis] = static_cast<int>(std::floor(x));
  }
  std::int32_t nearest = -1;
  double nearest_squared = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const int i = cell[0] + (corner & 1), j = cell[1] + (corner >> 1 & 1),
              k = cell[2] + (corner >> 2);
    const std::int32_t face = field_->faceAt(i, j, k);
    const double squared = (q - Vec3(i, j, k)).squaredNorm();
    if (face < 0 || squared >= nearest_squared) continue;
    nearest = face;
    nearest_squared = squared;
  }
  return nearest;
}

} // namespace patina
