// Scenes with paint, strokes, and their comparison, for tests and their helper programs.
#pragma once

#include <random>

#include "geometry/mesh/shapes.h"
#include "scene/scene.h"
#include "scene/stroke.h"

namespace patina {

inline Scene sceneWithObjects(double radius) {
  Scene scene;
  Pose pose = Pose::Identity();
  pose.translate(Vec3(0.1, -0.2, 1.0 / 3)).rotate(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
  scene.objects.push_back(
      {"ball", std::make_shared<const TriangleMesh>(icosphere(radius, 4)), pose});
  scene.objects.push_back({"crate-1",
                           std::make_shared<const TriangleMesh>(box(Vec3(1, 2, 3) * radius)),
                           Pose::Identity()});
  setValues(scene, {{"friction.static", "0.5"}, {"friction.dynamic", "0.3"}, {"band", "6"}});
  scene.haptics.stiffness = 1000 * radius;
  return scene;
}

// Values of any sign and size, in some tiles; different for each seed.
inline TiledImage paintedImage(int width, int height, int channels, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> value(0, 100);
  TiledImage image(width, height, channels);
  for (std::size_t t = seed % 2; t < image.tileCount(); t += 2) {
    float* texels = image.writable(t);
    for (std::size_t k = 0; k < image.sharedTile(t)->size(); k += 3) texels[k] = value(random);
  }
  return image;
}

inline MaterialMap paintedMaterial(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(0, 1);
  MaterialMap map(Vec3(-0.1, 0.2, 1.0 / 3), 0.001 * (1 + seed % 3));
  for (int b = 0; b < 4; ++b) {
    const MaterialMap::Index index{b - 2, static_cast<int>(seed % 7), -b * b};
    const MaterialChannel channel = kAllMaterialChannels[static_cast<std::size_t>(b + 1)];
    MaterialLayer& layer = map.writable(index, channel);
    for (float& v : layer.value) v = 1000 * value(random);
    for (float& w : layer.weight) w = value(random);
    map.writable(index, MaterialChannel::stiffness).weight[0] = value(random);
  }
  return map;
}

// The layout is like one of charts: every triangle has a place of its own.
inline CornerUvs someLayout(std::size_t triangles, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> at(0, 1);
  CornerUvs uvs(triangles);
  for (auto& corners : uvs)
    for (Vec2& uv : corners) uv = Vec2(at(random), at(random));
  return uvs;
}

enum class With { material, all };
inline std::shared_ptr<const ObjectPaint> somePaint(const TriangleMesh& mesh, unsigned seed,
                                                    With with) {
  ObjectPaint paint;
  paint.material = std::make_shared<const MaterialMap>(paintedMaterial(seed));
  paint.layout = {std::make_shared<const CornerUvs>(someLayout(mesh.triangles.size(), seed)), true,
                  static_cast<int>(seed)};
  if (with == With::all) {
    paint.color = std::make_shared<const TiledImage>(paintedImage(96, 64, kColorChannels, seed));
    paint.relief = std::make_shared<const TiledImage>(paintedImage(64, 128, 1, seed + 1));
  }
  return std::make_shared<const ObjectPaint>(std::move(paint));
}

inline Scene paintedScene(double radius, unsigned seed, With with) {
  Scene scene = sceneWithObjects(radius);
  scene.objects[0].paint = somePaint(*scene.objects[0].mesh, seed, with);
  return scene;
}

inline Stroke someStroke(int samples, double value) {
  Stroke stroke;
  stroke.brush.tool = Tool::material(MaterialChannel::stiffness);
  stroke.brush.value = value;
  for (int i = 0; i < samples; ++i)
    stroke.samples.push_back({i / 60.0, Vec3(0.01 * i, 1.0 / 3, -i), 0.1 * i});
  return stroke;
}

inline bool samePaint(const SceneObject& a, const SceneObject& b) {
  if (!a.paint || !b.paint) return !a.paint && !b.paint;
  return same(*a.paint, *b.paint) && a.paint->layout.charts == b.paint->layout.charts;
}

inline bool same(const Scene& a, const Scene& b) {
  if (values(a) != values(b) || a.objects.size() != b.objects.size()) return false;
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    const SceneObject& x = a.objects[i];
    const SceneObject& y = b.objects[i];
    if (x.name != y.name || x.mesh->positions != y.mesh->positions ||
        x.mesh->triangles != y.mesh->triangles ||
        x.world_from_object.matrix() != y.world_from_object.matrix() || !samePaint(x, y))
      return false;
  }
  return true;
}

} // namespace patina
