// Checks an atlas's contract over all pairs of faces, and makes a difficult mesh.
#pragma once

#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "geometry/atlas/texture_layout.h"

namespace patina::test {

using Corners = std::array<Vec2, 3>;

inline double cross(const Vec2& a, const Vec2& b) {
  return a[0] * b[1] - a[1] * b[0];
}

// Separation of two triangles along the best of their edges' normals; negative = depth of overlap.
// Both are counter-clockwise.
inline double separation(const Corners& a, const Corners& b) {
  double best = -std::numeric_limits<double>::infinity();
  for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 along = ((*one)[(k + 1) % 3] - (*one)[k]).normalized();
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vec2& p : *other) nearest = std::min(nearest, -cross(along, p - (*one)[k]));
      best = std::max(best, nearest);
    }
  return best;
}

// Returns the chart of each face; faces of a chart share two corners in space and in the image.
inline std::vector<int> chartsIn(const TriangleMesh& mesh, const CornerUvs& uvs) {
  std::vector<int> parent(uvs.size());
  for (std::size_t f = 0; f < parent.size(); ++f) parent[f] = static_cast<int>(f);
  const auto find = [&](int f) {
    while (parent[static_cast<std::size_t>(f)] != f) f = parent[static_cast<std::size_t>(f)];
    return f;
  };
  using Place = std::array<double, 5>;
  std::map<std::pair<Place, Place>, int> seen;
  for (std::size_t f = 0; f < uvs.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto place = [&](std::size_t c) {
        const Vec3 p = mesh.corner(f, static_cast<int>(c));
        return Place{p[0], p[1], p[2], uvs[f][c][0], uvs[f][c][1]};
      };
      const auto [at, fresh] =
          seen.try_emplace(std::minmax(place(k), place((k + 1) % 3)), static_cast<int>(f));
      if (!fresh) parent[static_cast<std::size_t>(find(static_cast<int>(f)))] = find(at->second);
    }
  for (std::size_t f = 0; f < parent.size(); ++f) parent[f] = find(static_cast<int>(f));
  return parent;
}

// Checks the header's contract over all pairs of faces. Every face must have area.
inline void expectAtlas(const TriangleMesh& mesh, const TextureLayout& layout, int size) {
  const CornerUvs& uvs = *layout.uvs;
  ASSERT_TRUE(layout.generated);
  ASSERT_EQ(uvs.size(), mesh.triangles.size());
  double largest = 0;
  std::vector<std::array<double, 2>> stretches;
  for (std::size_t f = 0; f < uvs.size(); ++f) {
    for (const Vec2& p : uvs[f]) {
      ASSERT_TRUE(p.allFinite());
      ASSERT_GE(p.minCoeff(), 0);
      ASSERT_LE(p.maxCoeff(), 1);
    }
    ASSERT_GT(cross(uvs[f][1] - uvs[f][0], uvs[f][2] - uvs[f][0]), 0) << "face " << f;
    // The map from the face's plane to the image.
    const Vec3 e1 = mesh.corner(f, 1) - mesh.corner(f, 0),
               e2 = mesh.corner(f, 2) - mesh.corner(f, 0);
    const Vec3 x = e1.normalized(), y = e1.cross(e2).cross(e1).normalized();
    Eigen::Matrix2d plane, image;
    plane << x.dot(e1), x.dot(e2), y.dot(e1), y.dot(e2);
    image << uvs[f][1] - uvs[f][0], uvs[f][2] - uvs[f][0];
    const Eigen::Matrix2d m = image * plane.inverse();
    const double a = std::hypot(m(0, 0) + m(1, 1), m(1, 0) - m(0, 1)),
                 b = std::hypot(m(0, 0) - m(1, 1), m(1, 0) + m(0, 1));
    const Vec2 values(0.5 * (a + b), 0.5 * std::abs(a - b)); // its singular values
    stretches.push_back({values[0], values[1]});
    largest = std::max(largest, values[0]);
  }
  for (const auto& [most, least] : stretches) {
    ASSERT_NEAR(most, largest, 1e-6 * largest); // equal in all charts
    ASSERT_GT(least, 0.5 * largest);
  }
  const std::vector<int> charts = chartsIn(mesh, uvs);
  std::vector<Eigen::AlignedBox2d> boxes(uvs.size());
  int count = 0;
  for (std::size_t f = 0; f < uvs.size(); ++f) {
    for (const Vec2& p : uvs[f]) boxes[f].extend(p);
    count += charts[f] == static_cast<int>(f);
  }
  EXPECT_EQ(layout.charts, count);
  const double gap = 2.0 * kGutter / size;
  for (std::size_t a = 0; a < uvs.size(); ++a)
    for (std::size_t b = a + 1; b < uvs.size(); ++b) {
      const bool same = charts[a] == charts[b];
      const double apart = boxes[a].exteriorDistance(boxes[b]);
      if (same ? apart > 0 : apart > 1.5 * gap) continue;
      // Triangles of two charts are separated by at least that along the best axis; for two corners
      // the distance may be larger by up to the square's diagonal.
      if (same) {
        ASSERT_GT(separation(uvs[a], uvs[b]), -1e-11) << "faces " << a << ' ' << b;
      } else {
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto& [one, other] : {std::pair(a, b), std::pair(b, a)})
          for (const Vec2& p : uvs[one])
            for (std::size_t k = 0; k < 3; ++k) {
              const Vec2 q = uvs[other][k], along = uvs[other][(k + 1) % 3] - q;
              const double t = std::clamp((p - q).dot(along) / along.squaredNorm(), 0., 1.);
              nearest = std::min(nearest, (p - q - t * along).norm());
            }
        ASSERT_GE(nearest, gap * (1 - 1e-9)) << "faces " << a << ' ' << b;
        ASSERT_GT(separation(uvs[a], uvs[b]), 0);
      }
    }
}

inline double share(const TextureLayout& layout) {
  double sum = 0;
  for (const Corners& uv : *layout.uvs) sum += cross(uv[1] - uv[0], uv[2] - uv[0]) / 2;
  return sum;
}

// A strip between two radii that climbs `turns` times around the axis.
inline TriangleMesh spiralRamp(double turns, double inner, double pitch, double widening) {
  TriangleMesh mesh;
  const int steps = static_cast<int>(turns * 24);
  for (int k = 0; k <= steps; ++k) {
    const double angle = 2 * std::numbers::pi * k / 24, grow = 1 + widening * k / 24;
    for (const double r : {inner, 1.0})
      mesh.positions.emplace_back(grow * r * std::cos(angle), grow * r * std::sin(angle),
                                  pitch * k / 24);
    if (k == 0) continue;
    const std::int32_t a = 2 * k - 2;
    mesh.triangles.push_back({a, a + 1, a + 3});
    mesh.triangles.push_back({a, a + 3, a + 2});
  }
  return mesh;
}

} // namespace patina::test
