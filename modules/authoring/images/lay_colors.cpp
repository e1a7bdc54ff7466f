#include "authoring/images/lay_colors.h"

#include <optional>

#include <tbb/parallel_for.h>

#include "authoring/images/picture_sample.h"
#include "core/error.h"
#include "geometry/atlas/texel_map.h"
#include "pictures/picture_file.h"

namespace patina {
namespace {

constexpr double kTexelsPerFace = 8; // so that what is one face's stays sharp
constexpr double kPacked = 0.6;      // of the unit square, by an atlas
constexpr double kFiner = 1.5;       // an atlas than the picture that is read into it, a side

using Pictures = std::vector<std::optional<Picture>>;

Pictures readPictures(const MeshColors& colors, std::vector<std::string>& warnings) {
  Pictures pictures;
  for (const MeshPicture& named : colors.pictures) {
    pictures.emplace_back();
    try {
      pictures.back() = readPicture(named.file);
    } catch (const Error& error) {
      warnings.push_back(std::string("a picture of the mesh is not shown: ") + error.what());
    }
  }
  return pictures;
}

const Picture* pictureOf(const MeshColors& colors, const Pictures& pictures, std::size_t face) {
  if (colors.picture_of.empty() || colors.picture_of[face] < 0) return nullptr;
  const auto& picture = pictures[static_cast<std::size_t>(colors.picture_of[face])];
  return picture ? &*picture : nullptr;
}

// Returns the texels of its picture that a face shows.
double texelsShown(const TriangleMesh& mesh, const MeshPicture& named, const Picture& picture,
                   std::size_t face) {
  const auto& uv = mesh.corner_uvs[face];
  const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
  return 0.5 * std::abs((a.x() * b.y() - a.y() * b.x()) * named.scale.prod()) * picture.width *
         picture.height;
}

// Returns the side that the image would have if nothing limited it.
double wantedSide(const TriangleMesh& mesh, const MeshColors& colors, const Pictures& pictures,
                  bool atlas) {
  double texels = 0, side = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Picture* picture = pictureOf(colors, pictures, f);
    if (!picture) {
      texels += kTexelsPerFace;
      continue;
    }
    const MeshPicture& named = colors.pictures[static_cast<std::size_t>(colors.picture_of[f])];
    if (atlas)
      texels += kFiner * kFiner * texelsShown(mesh, named, *picture, f);
    else
      side = std::max({side, named.scale.x() * picture->width, named.scale.y() * picture->height});
  }
  return std::max(side, std::sqrt(texels / kPacked));
}

int sideFor(double wanted, int least) {
  int side = least;
  while (side < wanted && side < kMostColorTexels) side *= 2;
  return std::min(side, kMostColorTexels);
}

// Returns what the face shows beneath or without its picture.
PictureSample plainColor(const TriangleMesh& mesh, const MeshColors& colors, std::size_t face,
                         const Vec3& w) {
  PictureSample sample;
  const auto add = [&](const Rgba& color, double share) {
    for (std::size_t c = 0; c < 3; ++c)
      sample.rgb[c] += share * static_cast<double>(color[3]) * static_cast<double>(color[c]);
    sample.alpha += share * static_cast<double>(color[3]);
  };
  if (!colors.vertices.empty())
    for (std::size_t k = 0; k < 3; ++k)
      add(colors.vertices[static_cast<std::size_t>(mesh.triangles[face][k])],
          w[static_cast<Eigen::Index>(k)]);
  if (!colors.faces.empty() && !(sample.alpha > 0)) add(colors.faces[face], 1);
  return sample;
}

} // namespace

std::shared_ptr<const ObjectPaint> paintOf(const TriangleMesh& mesh, const MeshColors& colors,
                                           int least, std::vector<std::string>& warnings) {
  if (colors.empty()) return nullptr;
  const Pictures pictures = readPictures(colors, warnings);
  auto paint = std::make_shared<ObjectPaint>();
  paint->layout = textureLayout(mesh, least);
  const double wanted = wantedSide(mesh, colors, pictures, paint->layout.made);
  const int side = sideFor(wanted, least);
  if (paint->layout.made && side != least) paint->layout = madeAtlas(mesh, side);
  const CornerUvs& uvs = *paint->layout.uvs;
  const TexelMap texels = texelMap(uvs, side, side);
  if (!pictures.empty() && wanted / (paint->layout.made ? kFiner : 1) > side)
    warnings.push_back("its pictures are finer than what is kept of them: " + std::to_string(side) +
                       " x " + std::to_string(side) + " texels");

  TiledImage image(side, side, kColorChannels);
  tbb::parallel_for(std::size_t{0}, image.tileCount(), [&](std::size_t tile) {
    const int i0 = static_cast<int>(tile) % image.tilesAcross() * kTileSide;
    const int j0 = static_cast<int>(tile) / image.tilesAcross() * kTileSide;
    for (int j = j0; j < j0 + kTileSide; ++j)
      for (int i = i0; i < i0 + kTileSide; ++i) {
        const std::int32_t owner = texels.ownerAt(i, j);
        if (owner < 0) continue;
        const auto f = static_cast<std::size_t>(owner);
        const Vec2 centre = texels.centre(i, j);
        PictureSample sample;
        if (const Picture* picture = pictureOf(colors, pictures, f)) {
          const MeshPicture& named =
              colors.pictures[static_cast<std::size_t>(colors.picture_of[f])];
          const auto& own = mesh.corner_uvs[f];
          sample = meanOver(*picture, named.repeats, centre, texels.step(), [&](const Vec2& at) {
            const Vec3 w = texelBarycentric(uvs[f], at.x(), at.y());
            const Vec2 t = w[0] * own[0] + w[1] * own[1] + w[2] * own[2];
            return Vec2(named.scale.cwiseProduct(t) + named.offset);
          });
        } else {
          sample = plainColor(mesh, colors, f, texelBarycentric(uvs[f], centre.x(), centre.y()));
        }
        if (!(sample.alpha > 0)) continue;
        float* value = image.writable(tile) + image.offsetOf(i, j);
        for (int c = 0; c < 3; ++c) value[c] = static_cast<float>(sample.rgb[c]);
        value[3] = static_cast<float>(sample.alpha);
      }
  });
  image.dropEmptyTiles();
  bool is_empty = true;
  for (std::size_t tile = 0; tile < image.tileCount(); ++tile)
    is_empty = is_empty && image.tile(tile) == nullptr;
  if (is_empty) return nullptr;
  paint->color = std::make_shared<const TiledImage>(std::move(image));
  return paint;
}

} // namespace patina
