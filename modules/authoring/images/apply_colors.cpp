#include "authoring/images/apply_colors.h"

#include <map>
#include <optional>

#include <tbb/parallel_for.h>

#include "authoring/images/picture_sample.h"
#include "core/error.h"
#include "core/numbers.h"
#include "geometry/atlas/texel_map.h"
#include "pictures/picture_file.h"

namespace patina {
namespace {

constexpr double kTexelsPerFace = 8; // keeps the colour of a single face sharp
constexpr double kPacked = 0.6;      // fraction of the unit square that an atlas fills
constexpr double kFiner = 1.5;       // resolution of an atlas over that of its sources, per side

// Each file once, for all materials that use it.
struct Pictures {
  std::vector<std::optional<Picture>> files;
  std::vector<std::size_t> file_of; // index of each picture's file
};

// Returns the picture at half its size: each texel is the mean of four, weighted by coverage.
Picture halved(const Picture& picture) {
  Picture half{picture.width / 2, picture.height / 2, picture.channels, {}};
  const auto channels = static_cast<std::size_t>(picture.channels);
  const bool covers = channels % 2 == 0;
  half.texel.resize(static_cast<std::size_t>(half.width) * static_cast<std::size_t>(half.height) *
                    channels);
  tbb::parallel_for(0, half.height, [&](int j) {
    for (int i = 0; i < half.width; ++i) {
      const auto texel = [&](int k) {
        return &picture.texel[channels * (static_cast<std::size_t>(2 * j + k / 2) *
                                              static_cast<std::size_t>(picture.width) +
                                          static_cast<std::size_t>(2 * i + k % 2))];
      };
      float* to = &half.texel[channels *
                              (static_cast<std::size_t>(j) * static_cast<std::size_t>(half.width) +
                               static_cast<std::size_t>(i))];
      float weight = 0;
      for (int k = 0; k < 4; ++k) weight += covers ? texel(k)[channels - 1] : 1;
      for (std::size_t c = 0; c < channels; ++c) {
        const bool coverage = covers && c == channels - 1;
        float sum = 0;
        for (int k = 0; k < 4; ++k)
          sum += texel(k)[c] * (covers && !coverage ? texel(k)[channels - 1] : 1);
        to[c] = coverage ? sum / 4 : weight > 0 ? sum / weight : 0;
      }
    }
  });
  return half;
}

// Reads each file once. Halves pictures with more than kMaxColorTexels a side until they fit, to
// bound the memory.
Pictures readPictures(const MeshColors& colors, std::vector<std::string>& warnings) {
  Pictures pictures;
  std::map<std::filesystem::path, std::size_t> known;
  std::string first_lost;
  std::size_t lost = 0, coarser = 0;
  for (const MeshPicture& named : colors.pictures) {
    const auto [file, is_new] = known.emplace(named.file, pictures.files.size());
    pictures.file_of.push_back(file->second);
    if (!is_new) continue;
    auto& picture = pictures.files.emplace_back();
    try {
      picture = readPicture(named.file);
      const bool fits = std::max(picture->width, picture->height) <= kMaxColorTexels;
      if (!fits) ++coarser;
      while (std::max(picture->width, picture->height) > kMaxColorTexels &&
             std::min(picture->width, picture->height) > 1)
        picture = halved(*picture);
    } catch (const Error& error) {
      if (lost++ == 0) first_lost = error.what();
    }
  }
  if (lost > 0)
    warnings.push_back((lost == 1 ? "a picture of the mesh is not shown: "
                                  : formatCount(lost) + " pictures of the mesh are not shown, the "
                                                        "first: ") +
                       first_lost);
  if (coarser > 0)
    warnings.push_back(formatCount(coarser) + " of its pictures have more than " +
                       std::to_string(kMaxColorTexels) + " texels a side and are kept coarser");
  return pictures;
}

const Picture* pictureOf(const MeshColors& colors, const Pictures& pictures, std::size_t face) {
  if (colors.picture_of.empty() || colors.picture_of[face] < 0) return nullptr;
  const auto named = static_cast<std::size_t>(colors.picture_of[face]);
  const auto& picture = pictures.files[pictures.file_of[named]];
  return picture ? &*picture : nullptr;
}

// Returns the number of picture texels that a face shows.
double texelsShown(const TriangleMesh& mesh, const MeshPicture& named, const Picture& picture,
                   std::size_t face) {
  const auto& uv = mesh.corner_uvs[face];
  const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
  return 0.5 * std::abs((a.x() * b.y() - a.y() * b.x()) * named.scale.prod()) * picture.width *
         picture.height;
}

// Returns the side of the image without limits.
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
      texels += texelsShown(mesh, named, *picture, f);
    else
      side = std::max({side, std::abs(named.scale.x()) * picture->width,
                       std::abs(named.scale.y()) * picture->height});
  }
  return std::max(side, std::sqrt(texels / kPacked));
}

int sideFor(double wanted, int least) {
  int side = least;
  while (side < wanted && 2 * side <= kMaxColorTexels) side *= 2;
  return side;
}

// Returns the face's colour beneath or without its picture.
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
  const bool atlas = !ownLayoutFault(mesh).empty();
  const double wanted = wantedSide(mesh, colors, pictures, atlas);
  const int side = sideFor((atlas ? kFiner : 1) * wanted, least);
  paint->layout = atlas ? generateAtlas(mesh, side) : textureLayout(mesh, side);
  const CornerUvs& uvs = *paint->layout.uvs;
  const TexelMap texels = texelMap(uvs, side, side);
  if (wanted > side)
    warnings.push_back("its colours are finer than the " + std::to_string(side) + " x " +
                       std::to_string(side) + " texels that are kept of them");

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
