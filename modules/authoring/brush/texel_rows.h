// Where the texels of an image lie on the surface, row by row: private to relief's measures.
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
// By face; zero where it has no area, in space or in the image. Parallel.
std::vector<TexelMetric> texelMetrics(const TriangleMesh& mesh, const CornerUvs& uvs, int width,
                                      int height);

struct TexelOnSurface {
  Eigen::Vector3f point; // [m] from the mesh's middle
  TexelMetric metric;
  bool shown = false;  // has an owner with a metric
  bool inside = false; // its centre is covered by the owner: not in a gutter
};

// A view of its arguments.
class TexelRows {
 public:
  TexelRows(const TriangleMesh& mesh, const CornerUvs& uvs, const TexelMap& texels,
            const std::vector<TexelMetric>& metrics);

  // Texels [i0, i0 + row.size()) of row j; nothing is shown outside the image.
  void read(int i0, int j, std::vector<TexelOnSurface>& row) const;

  // Whether texels that are neighbours in the image are neighbours on the surface: not across the
  // edge of a chart.
  static bool joined(const TexelOnSurface& a, const TexelOnSurface& b, int di, int dj);

 private:
  const TriangleMesh& mesh_;
  const CornerUvs& uvs_;
  const TexelMap& texels_;
  const std::vector<TexelMetric>& metrics_;
  Vec3 middle_;
};

} // namespace patina
