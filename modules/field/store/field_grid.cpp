#include "field/store/field_grid.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

double voxelFor(double longest, const FieldSpec& spec) {
  if (spec.voxel) {
    if (!(*spec.voxel > 0) || !std::isfinite(*spec.voxel))
      throw Error("field: the voxel must be a positive length, not " + formatNumber(*spec.voxel) +
                  " m");
    return *spec.voxel;
  }
  if (spec.resolution <= 2 * spec.band + 2)
    throw Error("field: resolution " + std::to_string(spec.resolution) +
                " leaves no room for the shape between two bands of " + formatNumber(spec.band) +
                " voxels; use more than " + formatNumber(2 * spec.band + 2) +
                ", or less tip radius, offset and relief, which widen the band");
  if (!(longest > 0)) throw Error("field: the shape has no size; give the voxel instead");
  return longest / (spec.resolution - 2 * spec.band);
}

} // namespace

FieldSpec widened(const FieldSpec& spec, const Box3& box, double reach, double margin) {
  FieldSpec wide = spec;
  if (!(reach > 0) || box.isEmpty()) return wide;
  // At resolution N, voxel = L / (N - 2 band), so that band >= reach / voxel + margin is linear in
  // band.
  const double longest = box.sizes().maxCoeff();
  const double band =
      spec.voxel ? reach / *spec.voxel + margin
                 : (reach * spec.resolution / longest + margin) / (1 + 2 * reach / longest);
  if (band > spec.band) wide.band = std::ceil(band - 1e-9);
  return wide;
}

FieldGrid gridAround(const Box3& box, const FieldSpec& spec) {
  if (box.isEmpty() || !box.min().allFinite() || !box.max().allFinite())
    throw Error("field: the shape has no finite bounds");
  if (!(spec.band >= 1) || !std::isfinite(spec.band))
    throw Error("field: the band must be at least one voxel, not " + formatNumber(spec.band));

  const Vec3 size = box.sizes();
  FieldGrid grid;
  grid.voxel = voxelFor(size.maxCoeff(), spec);
  Vec3 cells;
  for (int axis = 0; axis < 3; ++axis) {
    // The slack absorbs the rounding of the division, so that a scaled box gets the same count.
    cells[axis] = std::ceil(size[axis] / grid.voxel + 2 * spec.band - 1e-6);
    if (!(cells[axis] < kMaxNodes))
      throw Error("field: a voxel of " + formatLength(grid.voxel) + " needs " +
                  formatNumber(cells[axis]) + " cells on a side; the maximum is " +
                  std::to_string(kMaxNodes - 1) + "; choose a larger voxel or --unit");
    grid.nodes[static_cast<std::size_t>(axis)] = static_cast<int>(cells[axis]) + 1;
  }
  // Centred, so that a symmetric shape gets a symmetric field.
  grid.origin = box.center() - 0.5 * grid.voxel * cells;
  return grid;
}

} // namespace patina
