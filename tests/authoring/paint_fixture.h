// A scene prepared for the brush without the program's compile step.
#pragma once

#include <memory>

#include "authoring/brush/paint_surface.h"
#include "authoring/brush/painter.h"
#include "authoring/brush/surface_values.h"
#include "authoring/brush/volume_fill.h"
#include "field/construction/build_field.h"
#include "geometry/mesh/shapes.h"

namespace patina::test {

// The painted ball: its radius [m] and the contact point from above.
constexpr double kR = 0.05;
inline const Vec3 kTop(0, 0, kR);

inline SceneObject objectOf(const std::string& name, TriangleMesh mesh,
                            const Pose& pose = Pose::Identity()) {
  return {name, std::make_shared<const TriangleMesh>(std::move(mesh)), pose, nullptr};
}

inline Scene sceneOf(std::vector<SceneObject> objects, int resolution = 60, int paint_size = 128) {
  Scene scene;
  scene.objects = std::move(objects);
  scene.field.resolution = resolution;
  scene.paint_size = paint_size;
  return scene;
}

inline Scene sceneOf(TriangleMesh mesh, int resolution = 60, int paint_size = 128) {
  return sceneOf({objectOf("only", std::move(mesh))}, resolution, paint_size);
}

// The objects' meshes one after another, in the world.
inline TriangleMesh jointMesh(const Scene& scene) {
  TriangleMesh joint;
  for (const SceneObject& object : scene.objects) {
    const auto first = static_cast<std::int32_t>(joint.positions.size());
    for (const Vec3& p : object.mesh->positions)
      joint.positions.push_back(object.world_from_object * p);
    for (const Triangle& t : object.mesh->triangles)
      joint.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return joint;
}

inline std::shared_ptr<const PaintSurface> surfaceOf(const Scene& scene, bool images = true) {
  Progress progress;
  auto mesh = std::make_shared<const TriangleMesh>(jointMesh(scene));
  auto field = buildField(*mesh, scene.field, progress).field;
  auto surface = paintSurface(scene, std::move(mesh), std::move(field), progress);
  return images ? withImages(*surface, scene, progress) : surface;
}

inline Brush brushOf(Tool tool, double radius, double value = 0) {
  Brush brush;
  brush.tool = tool;
  brush.radius = radius;
  brush.value = value;
  return brush;
}

// A stroke of one dab, or at equal times along a line.
inline Stroke strokeAt(const Brush& brush, const Vec3& p) {
  return {brush, {{0, p, 0}}};
}
inline Stroke strokeAlong(const Brush& brush, const Vec3& from, const Vec3& to, int pieces) {
  Stroke stroke{brush, {}};
  for (int k = 0; k <= pieces; ++k) {
    const double t = static_cast<double>(k) / pieces;
    stroke.samples.push_back({t, from + t * (to - from), 0});
  }
  return stroke;
}

// Returns the painted values at the surface point nearest to p [m, world].
inline SurfaceValues valuesAt(const PaintSurface& surface, const Scene& scene, const Vec3& p,
                              std::size_t object = 0) {
  ClosestPoint best;
  best.distance = 1e9;
  const PaintObject& owner = surface.objects[object];
  for (std::int32_t f = owner.first_face; f < owner.first_face + owner.faces; ++f) {
    const auto face = static_cast<std::size_t>(f);
    const Vec3 a = surface.mesh->corner(face, 0), b = surface.mesh->corner(face, 1),
               c = surface.mesh->corner(face, 2);
    const Vec3 w = closestBarycentric(p, a, b, c);
    const double distance = (w[0] * a + w[1] * b + w[2] * c - p).norm();
    if (distance < best.distance) best = {{f - owner.first_face, w}, p, distance};
  }
  return surfaceValues(scene, object, best.surface);
}

// visit(point [m, world], i, j) for all texels that show something, gutters too.
template <typename Visit>
void forTexels(const PaintSurface& surface, std::size_t object, const TiledImage& image,
               const Visit& visit) {
  const PaintObject& owner = surface.objects[object];
  for (int j = 0; j < image.height(); ++j)
    for (int i = 0; i < image.width(); ++i) {
      const std::int32_t f = owner.texels->ownerAt(i, j);
      if (f < 0) continue;
      const auto& uv = (*owner.layout.uvs)[static_cast<std::size_t>(f)];
      const Vec3 w = texelBarycentric(uv, (i + 0.5) / image.width(), (j + 0.5) / image.height());
      const auto face = static_cast<std::size_t>(f + owner.first_face);
      visit(Vec3(w[0] * surface.mesh->corner(face, 0) + w[1] * surface.mesh->corner(face, 1) +
                 w[2] * surface.mesh->corner(face, 2)),
            i, j);
    }
}

} // namespace patina::test
