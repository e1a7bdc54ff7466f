#include "app/studies/contact/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>

#include "field/construction/build_field.h"
#include "field/merge/merge_fields.h"
#include "field/surface/models.h"
#include "geometry/mesh/shapes.h"

namespace patina {
namespace {

void addQuad(TriangleMesh& mesh, std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

TriangleMesh moved(const TriangleMesh& mesh, const Vec3& by) {
  return transformed(mesh, Eigen::Affine3d(Eigen::Translation3d(by)));
}

std::vector<Vec2> disc(double radius, int corners) {
  std::vector<Vec2> polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    polygon.push_back(radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

TriangleMesh dent() {
  const double radius = 0.04, depth = 0.012; // dent of a ball
  return reliefBlock(0.1, -0.03, 64, [=](double x, double y) {
    const double inside = radius * radius - x * x - y * y;
    return inside <= 0 ? 0 : std::min(0.0, radius - depth - std::sqrt(inside));
  });
}

// Tilted against the grid and scaled to 0.1 m again.
TriangleMesh turned(const TriangleMesh& mesh) {
  const TriangleMesh whole = tilted(mesh);
  const double scale = 0.1 / bounds(whole).sizes().maxCoeff();
  return transformed(whole, Eigen::Affine3d(Eigen::Scaling(scale)));
}

using Maker = std::function<ContactScene()>;

ContactScene one(TriangleMesh mesh) {
  return {"", {std::move(mesh)}};
}

const std::vector<std::pair<std::string, Maker>>& makers() {
  static const std::vector<std::pair<std::string, Maker>> all = {
      {"box", [] { return one(box(Vec3(0.1, 0.08, 0.06))); }},
      {"L", [] { return one(lSolid()); }},
      {"room", [] { return one(roomSolid()); }},
      {"roomt", [] { return one(turned(roomSolid())); }},
      {"wedge",
       [] {
         return one(prism({{-0.05, -0.03}, {0.05, -0.03}, {0.05, 0.04}}, 0.08));
       }},
      {"plate1", [] { return one(plateSolid(0.001)); }},
      {"plate2", [] { return one(plateSolid(0.002)); }},
      {"plate4", [] { return one(plateSolid(0.004)); }},
      {"plate2t", [] { return one(tilted(plateSolid(0.002))); }},
      {"plate4t", [] { return one(tilted(plateSolid(0.004))); }},
      {"bar", [] { return one(prism(disc(0.004, 64), 0.1)); }},
      {"groove", [] { return one(grooveSolid(90)); }},
      {"groove60t", [] { return one(turned(grooveSolid(60))); }},
      {"dent", [] { return one(dent()); }},
      {"spheres",
       [] {
         return ContactScene{"",
                             {moved(icosphere(0.03, 24), Vec3(-0.02, 0, 0)),
                              moved(icosphere(0.025, 24), Vec3(0.025, 0.003, 0.002))}};
       }},
      {"torus", [] { return one(torus(0.035, 0.015, 96, 48)); }},
      {"dinosaur", [] { return one(dinosaur(100)); }},
      // Sheets vanish at iso 0.
      {"galleon",
       [] {
         ContactScene scene = one(galleon(0.1));
         scene.isos = {1e-3, 2e-3};
         return scene;
       }},
      {"pottery", [] { return one(vase()); }},
      {"rough", [] { return one(roughSolid(5)); }},
      // Only isos at which the tip cannot enter its holes, because the oracle has no inside here.
      {"scan",
       [] {
         ContactScene scene = one(scanSolid(5));
         scene.isos = {1e-3, 2e-3};
         return scene;
       }},
  };
  return all;
}

} // namespace

TriangleMesh cellSolid(const std::vector<double>& x, const std::vector<double>& y,
                       const std::vector<double>& z,
                       const std::function<bool(int, int, int)>& filled) {
  const std::array<const std::vector<double>*, 3> lines = {&x, &y, &z};
  const auto cells = [&](int axis) {
    return static_cast<int>(lines[static_cast<std::size_t>(axis)]->size()) - 1;
  };
  const auto solid = [&](const Eigen::Vector3i& c) {
    for (int a = 0; a < 3; ++a)
      if (c[a] < 0 || c[a] >= cells(a)) return false;
    return filled(c[0], c[1], c[2]);
  };
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::int32_t> index;
  const auto vertex = [&](const Eigen::Vector3i& node) {
    const auto [entry, is_new] = index.try_emplace(
        {node[0], node[1], node[2]}, static_cast<std::int32_t>(mesh.positions.size()));
    if (is_new)
      mesh.positions.emplace_back(x[static_cast<std::size_t>(node[0])],
                                  y[static_cast<std::size_t>(node[1])],
                                  z[static_cast<std::size_t>(node[2])]);
    return entry->second;
  };
  for (int i = 0; i < cells(0); ++i)
    for (int j = 0; j < cells(1); ++j)
      for (int k = 0; k < cells(2); ++k) {
        const Eigen::Vector3i cell(i, j, k);
        if (!solid(cell)) continue;
        for (int a = 0; a < 3; ++a)
          for (const int side : {0, 1}) {
            const Eigen::Vector3i out = Eigen::Vector3i::Unit(a) * (2 * side - 1);
            if (solid(cell + out)) continue;
            const Eigen::Vector3i u = Eigen::Vector3i::Unit((a + 1) % 3);
            const Eigen::Vector3i v = Eigen::Vector3i::Unit((a + 2) % 3);
            const Eigen::Vector3i o = cell + side * Eigen::Vector3i::Unit(a);
            const Eigen::Vector3i p = side ? u : v, q = side ? v : u;
            addQuad(mesh, vertex(o), vertex(o + p), vertex(o + u + v), vertex(o + q));
          }
      }
  return mesh;
}

TriangleMesh prism(const std::vector<Vec2>& polygon, double width) {
  TriangleMesh mesh;
  const auto n = static_cast<std::int32_t>(polygon.size());
  for (const double y : {-0.5 * width, 0.5 * width})
    for (const Vec2& p : polygon) mesh.positions.emplace_back(p.x(), y, p.y());
  for (std::int32_t i = 0; i < n; ++i) {
    const std::int32_t next = (i + 1) % n;
    addQuad(mesh, i, n + i, n + next, next);
    if (i > 0 && next > 0) {
      mesh.triangles.push_back({0, i, next});
      mesh.triangles.push_back({n, n + next, n + i});
    }
  }
  return mesh;
}

TriangleMesh reliefBlock(double side, double floor, int cells,
                         const std::function<double(double, double)>& height) {
  TriangleMesh mesh;
  const int row = cells + 1;
  for (const bool top : {true, false})
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i) {
        const double x = side * (static_cast<double>(i) / cells - 0.5);
        const double y = side * (static_cast<double>(j) / cells - 0.5);
        mesh.positions.emplace_back(x, y, top ? height(x, y) : floor);
      }
  const auto at = [&](int i, int j, int layer) {
    return static_cast<std::int32_t>(layer * row * row + j * row + i);
  };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      addQuad(mesh, at(i, j, 0), at(i + 1, j, 0), at(i + 1, j + 1, 0), at(i, j + 1, 0));
      addQuad(mesh, at(i, j, 1), at(i, j + 1, 1), at(i + 1, j + 1, 1), at(i + 1, j, 1));
    }
  for (int i = 0; i < cells; ++i) {
    addQuad(mesh, at(i, 0, 1), at(i + 1, 0, 1), at(i + 1, 0, 0), at(i, 0, 0));
    addQuad(mesh, at(i + 1, cells, 1), at(i, cells, 1), at(i, cells, 0), at(i + 1, cells, 0));
    addQuad(mesh, at(0, i + 1, 1), at(0, i, 1), at(0, i, 0), at(0, i + 1, 0));
    addQuad(mesh, at(cells, i, 1), at(cells, i + 1, 1), at(cells, i + 1, 0), at(cells, i, 0));
  }
  return mesh;
}

TriangleMesh plateSolid(double thickness) {
  return box(Vec3(0.1, 0.1, thickness));
}
TriangleMesh tilted(const TriangleMesh& mesh) {
  const double angle = 40 * std::numbers::pi / 180;
  return transformed(mesh, Eigen::Affine3d(Eigen::AngleAxisd(angle, Vec3(1, 2, 3).normalized())));
}
TriangleMesh lSolid() {
  return cellSolid({-0.08, 0, 0.02}, {-0.04, 0.04}, {-0.02, 0, 0.05},
                   [](int i, int, int k) { return i == 1 || k == 0; });
}
TriangleMesh roomSolid() {
  const std::vector<double> lines = {-0.03, 0, 0.07};
  return cellSolid(lines, lines, lines,
                   [](int i, int j, int k) { return i == 0 || j == 0 || k == 0; });
}

TriangleMesh grooveSolid(double opening) {
  const double deep = 0.02, wide = deep * std::tan(opening * std::numbers::pi / 360);
  return prism({{0, 0},
                {-wide, deep},
                {-0.05, deep},
                {-0.05, -0.02},
                {0.05, -0.02},
                {0.05, deep},
                {wide, deep}},
               0.1);
}

TriangleMesh roughSolid(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  TriangleMesh mesh = icosphere(1, 20);
  const double edge = 0.045 * 1.2 / 20;
  for (Vec3& p : mesh.positions) {
    const double bumps =
        1 + 0.12 * std::sin(4 * p.x() + 1) * std::sin(5 * p.y()) + 0.06 * std::sin(9 * p.z() + 2);
    const Vec3 jitter(normal(random), normal(random), normal(random));
    // Uneven triangles along the surface, scanner noise across it.
    p = 0.045 * bumps * p + 0.15 * edge * (jitter - jitter.dot(p) * p) +
        0.15e-3 * normal(random) * p;
  }
  return mesh;
}

TriangleMesh scanSolid(unsigned seed) {
  TriangleMesh mesh = roughSolid(seed);
  std::vector<Triangle> left;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Vec3 a = mesh.corner(f, 0), b = mesh.corner(f, 1), c = mesh.corner(f, 2);
    const double inradius =
        (b - a).cross(c - a).norm() / ((b - a).norm() + (c - b).norm() + (a - c).norm());
    if (f % 40 != 0 || inradius > 0.9e-3) left.push_back(mesh.triangles[f]);
  }
  mesh.triangles = std::move(left);
  return mesh;
}

std::vector<std::string> contactSceneNames() {
  std::vector<std::string> names;
  for (const auto& [name, make] : makers()) names.push_back(name);
  return names;
}

ContactScene contactScene(const std::string& name) {
  std::string known;
  for (const auto& [other, make] : makers()) {
    if (other == name) {
      ContactScene scene = make();
      scene.name = name;
      return scene;
    }
    known += (known.empty() ? "" : ", ") + other;
  }
  throw std::invalid_argument("scene '" + name + "' is unknown; there are " + known);
}

std::vector<ContactScene> contactScenes() {
  std::vector<ContactScene> scenes;
  for (const std::string& name : contactSceneNames()) scenes.push_back(contactScene(name));
  return scenes;
}

unsigned trialSeed(const ContactScene& scene, double iso, unsigned seed) {
  for (const char letter : scene.name) seed = 31 * seed + static_cast<unsigned char>(letter);
  return 31 * seed + static_cast<unsigned>(std::lround(1e6 * iso));
}

std::shared_ptr<const SurfaceField> contactField(const ContactScene& scene, double iso,
                                                 int resolution) {
  Box3 box;
  for (const TriangleMesh& mesh : scene.meshes) box.extend(fieldBounds(mesh));
  FieldSpec spec;
  spec.resolution = resolution;
  spec = widened(spec, box, iso, kBandBeyondReach);
  const FieldGrid grid = gridAround(box, spec);
  Progress progress;
  if (scene.meshes.size() == 1)
    return withSamples(buildField(scene.meshes[0], grid, spec.band, progress, scene.sides).field);
  const BlockLattice lattice{grid.origin, grid.voxel};
  std::vector<FieldPart> parts;
  std::int32_t first_face = 0;
  for (const TriangleMesh& mesh : scene.meshes) {
    const BlockBox blocks = blocksAround(lattice, fieldBounds(mesh), spec.band);
    const auto field =
        buildField(mesh, gridOf(lattice, blocks), spec.band, progress, scene.sides).field;
    parts.push_back({field, firstBlock(lattice, field->grid), first_face});
    first_face += static_cast<std::int32_t>(mesh.triangles.size());
  }
  return withSamples(std::make_shared<const SurfaceField>(mergeFields(parts, lattice)));
}

std::shared_ptr<const HapticSnapshot> contactSnapshot(std::shared_ptr<const SurfaceField> field,
                                                      double iso, const std::string& contact) {
  Scene scene;
  if (!contact.empty()) setValue(scene, "contact", contact);
  scene.haptics.stiffness = kTestStiffness;
  scene.haptics.force_limit = 1e3;
  if (iso > 0) scene.haptics.tip_radius = iso;
  return compileStages(scene, std::move(field));
}

} // namespace patina
