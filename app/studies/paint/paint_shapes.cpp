#include "app/studies/paint/paint_shapes.h"

#include <cmath>

#include "geometry/mesh/shapes.h"
#include "session/open/session.h"

namespace patina {
namespace {

ObjectPaint paintOf(const Scene& slab) {
  const SceneObject& object = slab.objects[0];
  ObjectPaint paint = object.paint ? *object.paint : ObjectPaint{};
  if (!paint.layout.uvs) {
    paint.layout.uvs = std::make_shared<const CornerUvs>(object.mesh->corner_uvs);
    paint.layout.charts = 1;
  }
  return paint;
}

} // namespace

Scene slabScene(double side, double thickness, int resolution) {
  TriangleMesh mesh = box(Vec3(side, side, thickness), 8);
  for (Vec3& p : mesh.positions) p.z() -= 0.5 * thickness;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Vec2, 3> uv;
    const bool top = faceNormal(mesh, t).z() > 0.5;
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = mesh.corner(t, k);
      uv[static_cast<std::size_t>(k)] = top ? Vec2(std::clamp(p.x() / side + 0.5, 0.0, 1.0),
                                                   std::clamp(p.y() / side + 0.5, 0.0, 1.0))
                                            : Vec2(0, 0);
    }
    mesh.corner_uvs.push_back(uv);
  }
  Scene scene = sceneOf(std::move(mesh), "slab");
  scene.field.resolution = resolution;
  return scene;
}

void layEmptyColor(Scene& slab, int image_size) {
  ObjectPaint paint = paintOf(slab);
  paint.color = std::make_shared<const TiledImage>(image_size, image_size, kColorChannels);
  slab.objects[0].paint = std::make_shared<const ObjectPaint>(std::move(paint));
}

void layRelief(Scene& slab, double side, int image_size,
               const std::function<double(double, double)>& g) {
  auto image = std::make_shared<TiledImage>(image_size, image_size, 1);
  for (int j = 0; j < image_size; ++j) {
    for (int i = 0; i < image_size; ++i) {
      const double x = ((i + 0.5) / image_size - 0.5) * side;
      const double y = ((j + 0.5) / image_size - 0.5) * side;
      image->writable(image->tileOf(i, j))[image->offsetOf(i, j)] = static_cast<float>(g(x, y));
    }
  }
  ObjectPaint paint = paintOf(slab);
  paint.relief = std::move(image);
  slab.objects[0].paint = std::make_shared<const ObjectPaint>(std::move(paint));
}

void layMaterial(Scene& slab, double side, double voxel, double depth, MaterialChannel channel,
                 const std::function<double(const Vec3&)>& value) {
  const Vec3 origin(-0.5 * side, -0.5 * side, -depth);
  auto map = std::make_shared<MaterialMap>(origin, voxel);
  const auto blocks = [&](double length) {
    return static_cast<std::int32_t>(std::ceil(length / voxel / kMaterialSide)) + 1;
  };
  for (std::int32_t bz = 0; bz < blocks(2 * depth); ++bz) {
    for (std::int32_t by = 0; by < blocks(side); ++by) {
      for (std::int32_t bx = 0; bx < blocks(side); ++bx) {
        MaterialLayer& layer = map->writable({bx, by, bz}, channel);
        for (std::size_t n = 0; n < kMaterialNodes; ++n) {
          const Index3 node = BlockNode{{bx, by, bz}, n}.at();
          layer.value[n] =
              static_cast<float>(value(origin + voxel * Vec3(node[0], node[1], node[2])));
          layer.weight[n] = 1;
        }
      }
    }
  }
  ObjectPaint paint = paintOf(slab);
  paint.material = std::move(map);
  slab.objects[0].paint = std::make_shared<const ObjectPaint>(std::move(paint));
}

} // namespace patina
