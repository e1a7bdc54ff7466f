#include "geometry/mesh/shapes.h"

#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace patina {
namespace {

void require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

// The twelve vertices and twenty outward faces of the icosahedron.
const std::array<Vec3, 12>& icosahedronVertices() {
  static const std::array<Vec3, 12> vertices = [] {
    const double g = std::numbers::phi;
    std::array<Vec3, 12> v = {Vec3(-1, g, 0), Vec3(1, g, 0), Vec3(-1, -g, 0), Vec3(1, -g, 0),
                              Vec3(0, -1, g), Vec3(0, 1, g), Vec3(0, -1, -g), Vec3(0, 1, -g),
                              Vec3(g, 0, -1), Vec3(g, 0, 1), Vec3(-g, 0, -1), Vec3(-g, 0, 1)};
    for (Vec3& p : v) p.normalize();
    return v;
  }();
  return vertices;
}

constexpr std::array<Triangle, 20> kIcosahedronFaces = {
    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

// Vertices along the edges of the icosahedron, which two faces share: one run per edge, stored from
// the lower vertex to the higher.
class EdgeRuns {
 public:
  EdgeRuns(TriangleMesh& mesh, double radius, int frequency)
      : mesh_(mesh), radius_(radius), frequency_(frequency) {}

  std::int32_t at(std::int32_t from, std::int32_t to, int step) {
    if (from > to) {
      std::swap(from, to);
      step = frequency_ - step;
    }
    const auto [entry, is_new] =
        first_.try_emplace({from, to}, static_cast<std::int32_t>(mesh_.positions.size()));
    if (is_new) {
      const auto& corners = icosahedronVertices();
      const Vec3& a = corners[static_cast<std::size_t>(from)];
      const Vec3& b = corners[static_cast<std::size_t>(to)];
      for (int k = 1; k < frequency_; ++k)
        mesh_.positions.push_back(((frequency_ - k) * a + k * b).normalized() * radius_);
    }
    return entry->second + step - 1;
  }

 private:
  TriangleMesh& mesh_;
  double radius_;
  int frequency_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> first_;
};

void addQuad(TriangleMesh& mesh, std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

} // namespace

TriangleMesh icosphere(double radius, int frequency) {
  require(radius > 0 && frequency >= 1, "icosphere: radius > 0 and frequency >= 1 are needed");
  const int f = frequency;
  const auto& corners = icosahedronVertices();
  TriangleMesh mesh;
  mesh.positions.reserve(static_cast<std::size_t>(f) * static_cast<std::size_t>(f) * 10 + 2);
  mesh.triangles.reserve(static_cast<std::size_t>(f) * static_cast<std::size_t>(f) * 20);
  for (const Vec3& p : corners) mesh.positions.push_back(p * radius);
  EdgeRuns edges(mesh, radius, f);

  std::vector<std::int32_t> above, row; // lattice rows of one face, from corner a towards edge bc
  for (const auto& [ia, ib, ic] : kIcosahedronFaces) {
    const Vec3& a = corners[static_cast<std::size_t>(ia)];
    const Vec3& b = corners[static_cast<std::size_t>(ib)];
    const Vec3& c = corners[static_cast<std::size_t>(ic)];
    above.assign(1, ia);
    for (int i = 1; i <= f; ++i) {
      row.clear();
      for (int j = 0; j <= i; ++j) {
        if (i == f && (j == 0 || j == f)) {
          row.push_back(j == 0 ? ib : ic);
        } else if (j == 0) {
          row.push_back(edges.at(ia, ib, i));
        } else if (j == i) {
          row.push_back(edges.at(ia, ic, i));
        } else if (i == f) {
          row.push_back(edges.at(ib, ic, j));
        } else {
          row.push_back(static_cast<std::int32_t>(mesh.positions.size()));
          mesh.positions.push_back(((f - i) * a + (i - j) * b + j * c).normalized() * radius);
        }
      }
      for (std::size_t j = 0; j < above.size(); ++j) {
        mesh.triangles.push_back({above[j], row[j], row[j + 1]});
        if (j + 1 < above.size()) mesh.triangles.push_back({above[j], row[j + 1], above[j + 1]});
      }
      above.swap(row);
    }
  }
  return mesh;
}

TriangleMesh torus(double major_radius, double minor_radius, int around, int across) {
  require(minor_radius > 0 && major_radius > minor_radius && around >= 3 && across >= 3,
          "torus: major > minor > 0 and three steps each way are needed");
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    const double u = 2 * std::numbers::pi * i / around;
    for (int j = 0; j < across; ++j) {
      const double v = 2 * std::numbers::pi * j / across;
      const double r = major_radius + minor_radius * std::cos(v);
      mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), minor_radius * std::sin(v));
    }
  }
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const int i1 = (i + 1) % around;
      const int j1 = (j + 1) % across;
      addQuad(mesh, i * across + j, i1 * across + j, i1 * across + j1, i * across + j1);
    }
  return mesh;
}

TriangleMesh box(const Vec3& size, int cells) {
  require(size.minCoeff() > 0 && cells >= 1, "box: sizes > 0 and one cell or more are needed");
  TriangleMesh mesh;
  const std::int64_t side = cells + 1;
  std::unordered_map<std::int64_t, std::int32_t> index_of; // lattice point -> vertex
  const auto vertex = [&](const Eigen::Vector3i& lattice) {
    const std::int64_t key = (lattice[2] * side + lattice[1]) * side + lattice[0];
    const auto [entry, is_new] =
        index_of.try_emplace(key, static_cast<std::int32_t>(mesh.positions.size()));
    if (is_new)
      mesh.positions.push_back(
          (lattice.cast<double>() / cells - Vec3::Constant(0.5)).cwiseProduct(size));
    return entry->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const bool far_side : {false, true}) {
      const Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3);
      const Eigen::Vector3i v = Eigen::Vector3i::Unit((axis + 2) % 3);
      for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i) {
          const Eigen::Vector3i p =
              i * u + j * v + (far_side ? cells : 0) * Eigen::Vector3i::Unit(axis);
          if (far_side)
            addQuad(mesh, vertex(p), vertex(p + u), vertex(p + u + v), vertex(p + v));
          else
            addQuad(mesh, vertex(p), vertex(p + v), vertex(p + u + v), vertex(p + u));
        }
    }
  return mesh;
}

TriangleMesh vase(double height, double wall, int around, int along) {
  require(height > 0 && wall > 0 && wall < 0.1 * height && around >= 3 && along >= 2,
          "vase: 0 < wall < height / 10, three steps around and two along are needed");
  const auto radius = [&](double z) {
    const double t = z / height;
    return height * (0.24 + 0.10 * std::sin(2 * std::numbers::pi * (0.95 * t - 0.05)) + 0.02 * t);
  };
  const auto slope = [&](double z) {
    const double step = 1e-6 * height;
    return (radius(z + step) - radius(z - step)) / (2 * step);
  };
  // Profile from the axis at the bottom, up the outside, over the rim, down the inside to the axis.
  std::vector<Vec2> profile; // (r, z)
  for (int i = 0; i < along; ++i) {
    const double z = height * i / (along - 1);
    profile.emplace_back(radius(z), z);
  }
  for (int i = along - 1; i >= 0; --i) {
    const double z = wall + (height - wall) * i / (along - 1);
    profile.emplace_back(radius(z) - wall * std::hypot(1.0, slope(z)), z);
  }
  TriangleMesh mesh;
  for (const Vec2& p : profile)
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      mesh.positions.emplace_back(p[0] * std::cos(angle), p[0] * std::sin(angle), p[1]);
    }
  const auto below = static_cast<std::int32_t>(mesh.positions.size());
  mesh.positions.emplace_back(0, 0, 0);
  mesh.positions.emplace_back(0, 0, wall);
  const int rows = 2 * along;
  for (int k = 0; k < around; ++k) {
    const int k1 = (k + 1) % around;
    mesh.triangles.push_back({below, k1, k});
    for (int i = 0; i + 1 < rows; ++i)
      addQuad(mesh, i * around + k, i * around + k1, (i + 1) * around + k1, (i + 1) * around + k);
    mesh.triangles.push_back({below + 1, (rows - 1) * around + k, (rows - 1) * around + k1});
  }
  return mesh;
}

TriangleMesh sheet(double width, double depth, int cells) {
  require(width > 0 && depth > 0 && cells >= 1, "sheet: sizes > 0 and one cell or more are needed");
  TriangleMesh mesh;
  const int row = cells + 1;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      mesh.positions.emplace_back(width * (static_cast<double>(i) / cells - 0.5),
                                  depth * (static_cast<double>(j) / cells - 0.5), 0);
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const int p = j * row + i;
      addQuad(mesh, p, p + 1, p + row + 1, p + row);
    }
  return mesh;
}

TriangleMesh withShrunkenTriangles(const TriangleMesh& mesh, double fraction) {
  TriangleMesh result;
  result.positions.reserve(3 * mesh.triangles.size());
  result.triangles.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 centroid = (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3;
    const auto first = static_cast<std::int32_t>(result.positions.size());
    for (int k = 0; k < 3; ++k)
      result.positions.push_back(mesh.corner(t, k) + fraction * (centroid - mesh.corner(t, k)));
    result.triangles.push_back({first, first + 1, first + 2});
  }
  result.corner_uvs = mesh.corner_uvs;
  for (auto& uv : result.corner_uvs) {
    const Vec2 centre = (uv[0] + uv[1] + uv[2]) / 3;
    for (Vec2& c : uv) c += fraction * (centre - c);
  }
  return result;
}

} // namespace patina
