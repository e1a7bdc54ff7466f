// The ship of shapes.h: smooth open sheets with hard joins.
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

using Patch = std::function<Vec3(double u, double v)>; // u, v in [0, 1]

// Adds a grid of vertices over a patch with normal d/du x d/dv; returns the first vertex's index.
std::int32_t addPatch(TriangleMesh& mesh, const Patch& patch, int nu, int nv) {
  const auto first = static_cast<std::int32_t>(mesh.positions.size());
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i)
      mesh.positions.push_back(patch(static_cast<double>(i) / nu, static_cast<double>(j) / nv));
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      const std::int32_t p = first + j * (nu + 1) + i;
      mesh.triangles.push_back({p, p + 1, p + nu + 2});
      mesh.triangles.push_back({p, p + nu + 2, p + nu + 1});
    }
  return first;
}

// Adds an open tube whose last column of vertices is its first.
void addTube(TriangleMesh& mesh, const Vec3& foot, const Vec3& top, double radius, int around,
             int along) {
  const Vec3 axis = (top - foot).normalized();
  const Vec3 side = axis.cross(Vec3::UnitY()).normalized();
  const Vec3 other = axis.cross(side);
  const auto first = static_cast<std::int32_t>(mesh.positions.size());
  for (int j = 0; j <= along; ++j) {
    const double t = static_cast<double>(j) / along;
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      mesh.positions.push_back(foot + t * (top - foot) +
                               radius * (1 - 0.5 * t) *
                                   (std::cos(angle) * side + std::sin(angle) * other));
    }
  }
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i) {
      const std::int32_t a = first + j * around + i;
      const std::int32_t b = first + j * around + (i + 1) % around;
      mesh.triangles.push_back({a, b, b + around});
      mesh.triangles.push_back({a, b + around, a + around});
    }
}

constexpr int kAlong = 64;  // hull cells from stern to bow
constexpr int kGirth = 32;  // from the port rail round the keel to the starboard rail
constexpr int kRail = 3;    // rows of the hull that stand above the deck
constexpr int kAcross = 12; // deck cells from side to side
constexpr int kKeel = 53;   // cells of the fin below the keel

double halfBeam(double u) {
  return 0.012 + 0.088 * std::pow(std::sin(std::numbers::pi * (0.12 + 0.88 * u)), 0.7);
}
double sheer(double u) {
  return 0.075 + 0.10 * (u - 0.55) * (u - 0.55) + 0.05 * std::exp(-30 * u * u);
}

Vec3 hullPoint(double u, double v) {
  const double angle = std::numbers::pi * v; // 0 = port rail, pi = starboard rail
  const double depth = 0.10 * (1 - 0.25 * std::pow(2 * u - 1, 4));
  const double y = halfBeam(u) * std::cos(angle);
  const double z = sheer(u) - (sheer(u) + depth) * std::pow(std::sin(angle), 0.8);
  return {-0.5 + 0.86 * u, y, z};
}

std::int32_t hullVertex(int along, int girth) {
  return girth * (kAlong + 1) + along;
}

// Shares the hull's vertices on both sides, so that three faces meet along each edge there.
void addDeck(TriangleMesh& mesh) {
  const auto first = static_cast<std::int32_t>(mesh.positions.size());
  const int inner = kAcross - 1;
  const auto vertex = [&](int i, int j) {
    if (j == 0) return hullVertex(i, kRail);
    if (j == kAcross) return hullVertex(i, kGirth - kRail);
    return first + i * inner + j - 1;
  };
  for (int i = 0; i <= kAlong; ++i) {
    const Vec3 port = mesh.positions[static_cast<std::size_t>(hullVertex(i, kRail))];
    const Vec3 starboard = mesh.positions[static_cast<std::size_t>(hullVertex(i, kGirth - kRail))];
    for (int j = 1; j < kAcross; ++j) {
      const double t = static_cast<double>(j) / kAcross;
      const double camber = 0.006 * 4 * t * (1 - t);
      mesh.positions.push_back((1 - t) * port + t * starboard + camber * Vec3::UnitZ());
    }
  }
  for (int i = 0; i < kAlong; ++i)
    for (int j = 0; j < kAcross; ++j) {
      mesh.triangles.push_back({vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i + 1, j)});
    }
}

void addKeel(TriangleMesh& mesh) {
  const auto first = static_cast<std::int32_t>(mesh.positions.size());
  for (int i = 0; i <= kKeel; ++i)
    mesh.positions.push_back(mesh.positions[static_cast<std::size_t>(hullVertex(i, kGirth / 2))] -
                             0.015 * Vec3::UnitZ());
  for (int i = 0; i < kKeel; ++i) {
    const std::int32_t above = hullVertex(i, kGirth / 2);
    mesh.triangles.push_back({above, first + i, first + i + 1});
    mesh.triangles.push_back({above, first + i + 1, above + 1});
  }
}

void addMast(TriangleMesh& mesh, double x, double height) {
  const Vec3 foot(x, 0, 0.065);
  addTube(mesh, foot, foot + height * Vec3::UnitZ(), 0.008, 8, 16);
  constexpr std::array<double, 4> kLevels = {0.14, 0.45, 0.72, 0.93}; // mast heights
  for (std::size_t s = 0; s + 1 < kLevels.size(); ++s) {
    const double bottom = foot.z() + kLevels[s] * height;
    const double top = foot.z() + (kLevels[s + 1] - 0.02) * height;
    const double width = height * (0.30 - 0.06 * static_cast<double>(s));
    addPatch(
        mesh,
        [=](double u, double v) {
          const double belly = 0.10 * height * std::sin(std::numbers::pi * u) *
                               std::sin(std::numbers::pi * (0.2 + 0.7 * v));
          return Vec3(x + 0.012 + belly, width * (2 * u - 1) * (1 - 0.12 * v),
                      bottom + v * (top - bottom));
        },
        10, 12);
  }
}

} // namespace

TriangleMesh galleon(double length) {
  if (!(length > 0)) throw std::invalid_argument("galleon: length > 0 is needed");
  TriangleMesh mesh;
  addPatch(mesh, hullPoint, kAlong, kGirth);
  addDeck(mesh);
  addKeel(mesh);
  addMast(mesh, -0.33, 0.32);
  addMast(mesh, -0.08, 0.42);
  addMast(mesh, 0.17, 0.36);
  addTube(mesh, Vec3(0.30, 0, 0.085), Vec3(0.50, 0, 0.145), 0.007, 8, 8);
  const Box3 box = bounds(mesh);
  const double scale = length / box.sizes().x();
  for (Vec3& p : mesh.positions) p = (p - box.center()) * scale;
  return mesh;
}

} // namespace patina
