#include "authoring/images/lay_image.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <tbb/parallel_for.h>

#include "authoring/brush/texel_place.h"
#include "core/error.h"

namespace patina {
namespace {

constexpr int kMostSamples = 8; // a texel and axis, where the picture is finer than the image

struct Sample {
  double rgb[3], alpha;
  double grey() const { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }
};

// Premultiplied, so that what is transparent lends no colour to its neighbours.
Sample texelOf(const Picture& picture, int i, int j) {
  const auto at = (static_cast<std::size_t>(j) * static_cast<std::size_t>(picture.width) +
                   static_cast<std::size_t>(i)) *
                  static_cast<std::size_t>(picture.channels);
  const float* value = &picture.texel[at];
  const bool grey = picture.channels < 3;
  Sample sample{{}, 1};
  if (picture.channels % 2 == 0) sample.alpha = static_cast<double>(value[picture.channels - 1]);
  for (int c = 0; c < 3; ++c)
    sample.rgb[c] = sample.alpha * static_cast<double>(value[grey ? 0 : c]);
  return sample;
}

int wrapped(int i, int n, bool repeats) {
  return repeats ? (i % n + n) % n : std::clamp(i, 0, n - 1);
}

// Bilinear; adds `share` of it.
void read(const Picture& picture, const Vec2& uv, bool repeats, double share, Sample& sum) {
  const Vec2 inside = repeats ? Vec2(uv.array() - uv.array().floor()) : uv;
  const double x = inside.x() * picture.width - 0.5, y = inside.y() * picture.height - 0.5;
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  for (int corner = 0; corner < 4; ++corner) {
    const int di = corner & 1, dj = corner >> 1;
    const double part = share * (di ? x - i : 1 - (x - i)) * (dj ? y - j : 1 - (y - j));
    const Sample texel = texelOf(picture, wrapped(i + di, picture.width, repeats),
                                 wrapped(j + dj, picture.height, repeats));
    for (int c = 0; c < 3; ++c) sum.rgb[c] += part * texel.rgb[c];
    sum.alpha += part * texel.alpha;
  }
}

// From a point of the surface to the picture.
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
    // Upright with z up and, along z, with y up.
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

// The mean of the picture over one texel of the image.
Sample sampleOver(const Picture& picture, const Mapping& mapping, const std::array<Vec2, 3>& uv,
                  std::size_t face, const TexelMap& texels, int i, int j) {
  const Vec2 step(1.0 / texels.width, 1.0 / texels.height);
  const Vec2 centre((i + 0.5) * step.x(), (j + 0.5) * step.y());
  const auto at = [&](const Vec2& place) {
    return mapping.at(face, texelBarycentric(uv, place.x(), place.y()));
  };
  const Vec2 size(picture.width, picture.height);
  double finer = 0; // texels of the picture in one of the image
  for (const Vec2& side : {Vec2(step.x() / 2, 0), Vec2(0, step.y() / 2)})
    finer = std::max(finer, (at(centre + side) - at(centre - side)).cwiseProduct(size).norm());
  const int n = static_cast<int>(std::ceil(std::clamp(finer, 1.0, double{kMostSamples})));
  Sample sum{{}, 0};
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const Vec2 place =
          centre + Vec2(((x + 0.5) / n - 0.5) * step.x(), ((y + 0.5) / n - 0.5) * step.y());
      read(picture, at(place), mapping.repeats(), 1.0 / (n * n), sum);
    }
  return sum;
}

void check(const Picture& picture) {
  const auto count = static_cast<std::size_t>(std::max(0, picture.width)) *
                     static_cast<std::size_t>(std::max(0, picture.height)) *
                     static_cast<std::size_t>(std::max(0, picture.channels));
  if (count == 0 || picture.channels > 4 || picture.texel.size() != count)
    throw std::invalid_argument("laid: not a picture");
}

} // namespace

std::shared_ptr<const ObjectPaint> laid(const PaintSurface& surface, const Scene& scene,
                                        std::size_t object, const Picture& picture,
                                        Projection projection, PictureTarget target) {
  check(picture);
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
        const Sample sample = sampleOver(picture, mapping, (*made.layout.uvs)[f], f, texels, i, j);
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
