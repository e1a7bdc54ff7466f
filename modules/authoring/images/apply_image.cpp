#include "authoring/images/apply_image.h"

#include <stdexcept>

#include <tbb/parallel_for.h>

#include "authoring/images/picture_sample.h"
#include "core/error.h"

namespace patina {
namespace {

// Maps a point of the surface to the picture.
class Mapping {
 public:
  Mapping(const TriangleMesh& mesh, Projection projection)
      : mesh_(&mesh), projection_(projection), box_(bounds(mesh)) {}

  bool repeats() const { return projection_ == Projection::mapped; }
  Vec2 at(std::size_t face, const Vec3& w) const {
    if (projection_ == Projection::mapped) {
      const auto& uv = mesh_->corner_uvs[face];
      return w[0] * uv[0] + w[1] * uv[1] + w[2] * uv[2];
    }
    const Vec3 p = w[0] * mesh_->corner(face, 0) + w[1] * mesh_->corner(face, 1) +
                   w[2] * mesh_->corner(face, 2);
    // Upright: z is up, or y along z.
    const int right = projection_ == Projection::x ? 1 : 0;
    const int up = projection_ == Projection::z ? 1 : 2;
    return {part(p, right), part(p, up)};
  }

 private:
  double part(const Vec3& p, int axis) const {
    const double size = box_.sizes()[axis];
    return size > 0 ? (p[axis] - box_.min()[axis]) / size : 0.5;
  }
  const TriangleMesh* mesh_;
  Projection projection_;
  Box3 box_;
};

} // namespace

std::shared_ptr<const ObjectPaint> laid(const PaintSurface& surface, const Scene& scene,
                                        std::size_t object, const Picture& picture,
                                        Projection projection, PictureTarget target) {
  requirePicture(picture);
  const SceneObject& owner = scene.objects.at(object);
  const PaintObject& made = surface.objects.at(object);
  const TriangleMesh& mesh = *owner.mesh;
  if (!made.texels) throw std::invalid_argument("laid: the surface has no images");
  if (projection == Projection::mapped && mesh.corner_uvs.size() != mesh.triangles.size())
    throw Error("object '" + owner.name + "' has no texture coordinates: project the picture");

  const TexelMap& texels = *made.texels;
  auto paint = std::make_shared<ObjectPaint>(owner.paint ? *owner.paint : ObjectPaint{});
  paint->layout = made.layout;
  const bool color = target == PictureTarget::color;
  const int channels = color ? kColorChannels : 1;
  const std::shared_ptr<const TiledImage>& before = color ? paint->color : paint->relief;
  TiledImage image = before ? *before : TiledImage(texels.width, texels.height, channels);
  const Mapping mapping(mesh, projection);
  tbb::parallel_for(std::size_t{0}, image.tileCount(), [&](std::size_t tile) {
    const int i0 = static_cast<int>(tile) % image.tilesAcross() * kTileSide;
    const int j0 = static_cast<int>(tile) / image.tilesAcross() * kTileSide;
    for (int j = j0; j < j0 + kTileSide; ++j)
      for (int i = i0; i < i0 + kTileSide; ++i) {
        const std::int32_t face = texels.ownerAt(i, j);
        if (face < 0) continue;
        const auto f = static_cast<std::size_t>(face);
        const auto& uv = (*made.layout.uvs)[f];
        const PictureSample sample = meanOver(
            picture, mapping.repeats(), texels.centre(i, j), texels.step(), [&](const Vec2& place) {
              return mapping.at(f, texelBarycentric(uv, place.x(), place.y()));
            });
        if (!(sample.alpha > 0)) continue;
        float* value = image.writable(tile) + image.offsetOf(i, j);
        const double lay[4] = {color ? sample.rgb[0] : sample.grey(), sample.rgb[1], sample.rgb[2],
                               sample.alpha};
        for (int c = 0; c < channels; ++c)
          value[c] =
              static_cast<float>(lay[c] + (1 - sample.alpha) * static_cast<double>(value[c]));
      }
  });
  image.dropEmptyTiles();
  (color ? paint->color : paint->relief) = std::make_shared<const TiledImage>(std::move(image));
  return paint;
}

} // namespace patina
