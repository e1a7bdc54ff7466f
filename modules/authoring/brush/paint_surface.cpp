#include "authoring/brush/paint_surface.h"

#include <algorithm>
#include <stdexcept>

#include "field/construction/build_field.h"
#include "geometry/mesh/vertex_weld.h"

namespace patina {
namespace {

std::shared_ptr<const TiledImage> anyImage(const SceneObject& object) {
  if (!object.paint) return nullptr;
  return object.paint->color ? object.paint->color : object.paint->relief;
}

std::shared_ptr<const TriangleMesh> weldedByPlace(const std::shared_ptr<const TriangleMesh>& mesh,
                                                  const Scene& scene) {
  std::vector<std::int32_t> one(mesh->positions.size());
  std::vector<Vec3> places;
  std::size_t first = 0; // first vertex of the object
  for (const SceneObject& object : scene.objects) {
    const std::size_t count = object.mesh->positions.size();
    VertexWeld weld(count);
    const auto before = static_cast<std::int32_t>(places.size());
    for (std::size_t v = first; v < first + count; ++v)
      one[v] = before + weld.index(mesh->positions[v]);
    places.insert(places.end(), weld.points().begin(), weld.points().end());
    first += count;
  }
  if (places.size() == mesh->positions.size()) return mesh;
  auto welded = std::make_shared<TriangleMesh>();
  welded->positions = std::move(places);
  welded->triangles = mesh->triangles;
  for (Triangle& t : welded->triangles)
    for (std::int32_t& v : t) v = one[index(v)];
  return welded;
}

} // namespace

std::size_t PaintSurface::bytes() const {
  std::size_t sum = adjacency ? patina::bytes(*adjacency) : 0;
  if (welded && welded != mesh)
    sum += welded->positions.capacity() * sizeof(Vec3) +
           welded->triangles.capacity() * sizeof(Triangle);
  for (const PaintObject& object : objects) {
    if (object.layout.uvs) sum += object.layout.uvs->capacity() * sizeof(object.layout.uvs->at(0));
    if (object.texels) sum += object.texels->owner.capacity() * sizeof(std::int32_t);
  }
  return sum;
}

std::shared_ptr<const PaintSurface> paintSurface(const Scene& scene,
                                                 std::shared_ptr<const TriangleMesh> mesh,
                                                 std::shared_ptr<const SurfaceField> field,
                                                 Progress& progress) {
  auto surface = std::make_shared<PaintSurface>();
  std::size_t first = 0;
  for (const SceneObject& object : scene.objects) {
    PaintObject& made = surface->objects.emplace_back();
    made.first_face = static_cast<std::int32_t>(first);
    made.faces = static_cast<std::int32_t>(object.mesh->triangles.size());
    made.world_from_object = object.world_from_object;
    made.middle = fieldBounds(*object.mesh).center();
    first += object.mesh->triangles.size();
  }
  if (!mesh || !field || mesh->triangles.size() != first)
    throw std::invalid_argument("paintSurface: not the mesh of this scene");
  progress.throwIfCancelled();
  progress.report(0, "neighbours");
  surface->welded = weldedByPlace(mesh, scene);
  surface->adjacency = std::make_shared<const Adjacency>(adjacency(*surface->welded));
  progress.throwIfCancelled();
  surface->mesh = std::move(mesh);
  surface->field = std::move(field);
  progress.report(1, "neighbours");
  return surface;
}

std::shared_ptr<const PaintSurface> withImages(const PaintSurface& surface, const Scene& scene,
                                               Progress& progress) {
  if (scene.objects.size() != surface.objects.size())
    throw std::invalid_argument("withImages: not the surface of this scene");
  auto result = std::make_shared<PaintSurface>(surface);
  const auto count = static_cast<double>(result->objects.size());
  for (std::size_t i = 0; i < result->objects.size(); ++i) {
    progress.throwIfCancelled();
    progress.report(static_cast<double>(i) / count, "charts");
    const SceneObject& object = scene.objects[i];
    PaintObject& made = result->objects[i];
    const std::shared_ptr<const TiledImage> image = anyImage(object);
    const int width = image ? image->width() : scene.paint_size;
    const int height = image ? image->height() : scene.paint_size;
    const bool same_size =
        made.texels && made.texels->width == width && made.texels->height == height;
    if (same_size && (!image || made.layout.uvs == object.paint->layout.uvs)) continue;
    made.layout = image ? object.paint->layout : textureLayout(*object.mesh, width);
    progress.throwIfCancelled();
    made.texels = std::make_shared<const TexelMap>(texelMap(*made.layout.uvs, width, height));
  }
  progress.report(1, "charts");
  return result;
}

bool hasImages(const PaintSurface& surface) {
  return std::all_of(surface.objects.begin(), surface.objects.end(),
                     [](const PaintObject& object) { return object.texels != nullptr; });
}

} // namespace patina
