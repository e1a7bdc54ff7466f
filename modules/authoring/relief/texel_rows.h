// Positions of an image's texels on the surface, row by row. Internal to relief.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/atlas/texel_map.h"

namespace patina {

// First fundamental form of a face in texels: |d|^2 [m^2] = uu di^2 + 2 uv di dj + vv dj^2.
struct TexelMetric {
  float uu = 0, uv = 0, vv = 0;

  float determinant() const { return uu * vv - uv * uv; }
  float squaredLength(int di, int dj) const {
    const auto i = static_cast<float>(di), j = static_cast<float>(dj);
    return i * i * uu + 2 * i * j * uv + j * j * vv;
  }
};
// Returns the metric of each face; zero without area in space or in the image. Parallel.
std::vector<TexelMetric> texelMetrics(const TriangleMesh& mesh, const CornerUvs& uvs, int width,
                                      int height);

struct TexelOnSurface {
  Eigen::Vector3f point; // [m], relative to the mesh's middle
  TexelMetric metric;
  bool shown = false;  // has an owner with a metric
  bool inside = false; // the owner covers its centre: not in a gutter
};

// View of its arguments.
class TexelRows {
 public:
  TexelRows(const TriangleMesh& mesh, const CornerUvs& uvs, const TexelMap& texels,
            const std::vector<TexelMetric>& metrics);

  // Reads texels [i0, i0 + row.size()) of row j; none are shown outside the image.
  void read(int i0, int j, std::vector<TexelOnSurface>& row) const;

  // Returns true if texels adjacent in the image are adjacent on the surface, not across a chart's
  // edge.
  static bool joined(const TexelOnSurface& a, const TexelOnSurface& b, int di, int dj);

 private:
  const TriangleMesh& mesh_;
  const CornerUvs& uvs_;
  const TexelMap& texels_;
  const std::vector<TexelMetric>& metrics_;
  Vec3 middle_;
};

} // namespace patina
