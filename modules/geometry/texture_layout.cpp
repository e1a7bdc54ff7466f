#include "geometry/texture_layout.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "geometry/adjacency.h"

namespace patina {
namespace {

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

int axisOf(const Vec3& normal) { // 0 .. 5, -1 without area
  if (normal.isZero()) return -1;
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (normal[axis] < 0 ? 1 : 0);
}

Vec2 projected(const Vec3& p, int axis) {
  const int k = axis / 2, a = (k + 1) % 3, b = (k + 2) % 3;
  return axis % 2 == 0 ? Vec2(p[a], p[b]) : Vec2(p[b], p[a]);
}

struct Chart {
  std::vector<std::int32_t> faces;
  int axis = 0;
  Vec2 low, size;
};

std::vector<Chart> chartsOf(const TriangleMesh& mesh) {
  const Adjacency neighbours = adjacency(mesh);
  std::vector<int> axis(mesh.triangles.size());
  for (std::size_t f = 0; f < axis.size(); ++f) axis[f] = axisOf(faceNormal(mesh, f));
  std::vector<bool> taken(axis.size(), false);
  std::vector<Chart> charts;
  for (std::size_t seed = 0; seed < axis.size(); ++seed) {
    if (taken[seed] || axis[seed] < 0) continue;
    Chart chart;
    chart.axis = axis[seed];
    chart.faces = {static_cast<std::int32_t>(seed)};
    taken[seed] = true;
    Eigen::AlignedBox2d box;
    for (std::size_t k = 0; k < chart.faces.size(); ++k) {
      const std::size_t f = index(chart.faces[k]);
      for (int c = 0; c < 3; ++c) box.extend(projected(mesh.corner(f, c), chart.axis));
      for (const std::int32_t next : neighbours.face_neighbours[f])
        if (next >= 0 && !taken[index(next)] && axis[index(next)] == chart.axis) {
          taken[index(next)] = true;
          chart.faces.push_back(next);
        }
    }
    chart.low = box.min();
    chart.size = box.sizes();
    charts.push_back(std::move(chart));
  }
  return charts;
}

// Shelves of falling height; empty if they are higher than the image.
std::vector<Vec2> shelves(const std::vector<Chart>& charts, const std::vector<std::size_t>& order,
                          double scale, int size) {
  std::vector<Vec2> corner(charts.size());
  double x = kGutter, y = kGutter, height = 0;
  for (const std::size_t c : order) {
    const Vec2 extent = charts[c].size * scale;
    if (x + extent[0] + kGutter > size) {
      x = kGutter;
      y += height + 2 * kGutter;
      height = 0;
    }
    corner[c] = {x, y};
    x += extent[0] + 2 * kGutter;
    height = std::max(height, extent[1]);
    if (y + height + kGutter > size || corner[c][0] + extent[0] + kGutter > size) return {};
  }
  return corner;
}

} // namespace

TextureLayout madeAtlas(const TriangleMesh& mesh, int image_size) {
  if (image_size < 16 || image_size > 16384)
    throw std::invalid_argument("an atlas has 16 to 16384 texels a side");
  const std::vector<Chart> charts = chartsOf(mesh);
  std::vector<std::size_t> order(charts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return charts[a].size[1] > charts[b].size[1];
  });
  double longest = 0;
  for (const Chart& chart : charts) longest = std::max(longest, chart.size.maxCoeff());
  double low = 0, high = longest > 0 ? image_size / longest : 0;
  std::vector<Vec2> corner = shelves(charts, order, 0, image_size);
  for (int step = 0; step < 20 && high > 0; ++step) {
    const double middle = (low + high) / 2;
    std::vector<Vec2> tried = shelves(charts, order, middle, image_size);
    if (tried.empty()) {
      high = middle;
    } else {
      low = middle;
      corner = std::move(tried);
    }
  }
  if (corner.empty()) corner.assign(charts.size(), Vec2::Constant(image_size / 2.0));
  auto uvs = std::make_shared<CornerUvs>(mesh.triangles.size());
  for (auto& uv : *uvs) uv.fill(Vec2::Constant(0.5));
  for (std::size_t c = 0; c < charts.size(); ++c)
    for (const std::int32_t f : charts[c].faces)
      for (int k = 0; k < 3; ++k)
        (*uvs)[index(f)][static_cast<std::size_t>(k)] =
            (corner[c] +
             low * (projected(mesh.corner(index(f), k), charts[c].axis) - charts[c].low)) /
            image_size;
  return {std::move(uvs), true, static_cast<int>(charts.size())};
}

TextureLayout textureLayout(const TriangleMesh& mesh, int image_size, std::string* why_made) {
  std::string why;
  if (mesh.corner_uvs.size() != mesh.triangles.size()) why = "the mesh has no texture coordinates";
  bool has_area = false;
  for (const auto& uv : mesh.corner_uvs) {
    for (const Vec2& p : uv) {
      if (!p.allFinite())
        why = "texture coordinates are not finite";
      else if (p.minCoeff() < 0 || p.maxCoeff() > 1)
        why = "texture coordinates leave the unit square";
    }
    const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
    has_area = has_area || a[0] * b[1] != a[1] * b[0];
  }
  if (why.empty() && !has_area) why = "texture coordinates have no area";
  if (why_made) *why_made = why;
  if (!why.empty()) return madeAtlas(mesh, image_size);
  return {std::make_shared<CornerUvs>(mesh.corner_uvs), false, 1};
}

} // namespace patina
