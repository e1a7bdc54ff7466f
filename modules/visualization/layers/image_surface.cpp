#include "visualization/layers/image_surface.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkShaderProperty.h>

#include "scene/relief_slope.h"
#include "visualization/surfaces/surface_data.h"
#include "visualization/values/palette.h"
#include "visualization/view/scene_furniture.h"

namespace patina {
namespace {

// Turns the normal as displacement along it by the relief would: n - grad h. Decodes
// encodedSlope().
constexpr const char* kSlopeName = "reliefSlope";
constexpr const char* kSlopeShader =
    "//VTK::Normal::Impl\n"
    "  vec3 reliefBytes = texture(reliefSlope, tcoordVCVSOutput).rgb * 255.0;\n"
    "  vec3 reliefRoot = (reliefBytes - 128.0) / 127.0;\n"
    "  vec3 reliefTilt = normalMatrix * (2.0 * reliefRoot * abs(reliefRoot));\n"
    "  normalVCVSOutput = normalize(normalVCVSOutput - (gl_FrontFacing ? 1.0 : -1.0) * "
    "reliefTilt);\n";
constexpr const char* kNormalTag = "//VTK::Normal::Impl";

vtkSmartPointer<vtkImageData> texture(int width, int height, int components) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(width, height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, components);
  return image;
}

bool fits(vtkImageData& image, int width, int height) {
  const int* size = image.GetDimensions();
  return size[0] == width && size[1] == height;
}

unsigned char byteOf(double share) {
  return static_cast<unsigned char>(std::clamp(share, 0.0, 1.0) * 255 + 0.5);
}

vtkSmartPointer<vtkTexture> smooth(vtkImageData* image) {
  auto made = vtkSmartPointer<vtkTexture>::New();
  made->InterpolateOn();
  made->RepeatOff();
  made->EdgeClampOn();
  made->SetInputData(image);
  return made;
}

// Texels [i0, i1) x [j0, j1) of a tile, grown by a margin.
TexelBox boxOf(const TiledImage& image, std::size_t tile, int margin) {
  const int i = static_cast<int>(tile) % image.tilesAcross() * kTileSide;
  const int j = static_cast<int>(tile) / image.tilesAcross() * kTileSide;
  return {std::max(0, i - margin), std::max(0, j - margin),
          std::min(image.width(), i + kTileSide + margin),
          std::min(image.height(), j + kTileSide + margin)};
}

} // namespace

std::vector<std::size_t> changedTiles(const TiledImage* before, const TiledImage& now) {
  std::vector<std::size_t> tiles;
  const bool alike = before != nullptr && before->width() == now.width() &&
                     before->height() == now.height() && before->channels() == now.channels();
  for (std::size_t tile = 0; tile < now.tileCount(); ++tile)
    if (!alike || before->tile(tile) != now.tile(tile)) tiles.push_back(tile);
  return tiles;
}

ImageSurface::ImageSurface()
    : actor_(surfaceActor(palette::kSurface)), ink_(texture(2, 2, 4)), ink_texture_(smooth(ink_)) {
  const vtkNew<vtkProperty> inner;
  inner->DeepCopy(actor_->GetProperty());
  inner->SetColor(palette::forVtk(palette::kSurfaceBack));
  inner->SetSpecular(0);
  actor_->SetBackfaceProperty(inner);
  vtkProperty* property = actor_->GetProperty();
  property->SetColor(1, 1, 1); // the texture has the object's own colour in it
  property->ShowTexturesOnBackfaceOff();
  actor_->SetTexture(ink_texture_);
}

void ImageSurface::set(const SceneObject& object, double height,
                       std::shared_ptr<const TexelMap> texels) {
  const auto& uvs = object.paint->layout.uvs;
  if (object.mesh != mesh_ || uvs != uvs_) {
    mesh_ = object.mesh;
    uvs_ = uvs;
    texels_ = nullptr;
    ink_image_ = slope_image_ = height_image_ = nullptr;
    least_ = most_ = 0;
    vtkPolyDataMapper::SafeDownCast(actor_->GetMapper())->SetInputData(texturedData(*mesh_, *uvs_));
  }
  if (texels) texels_ = std::move(texels);
  place(*actor_, object.world_from_object);
  paint_ = object.paint;
  height_ = height;
}

ValueRange ImageSurface::heights() {
  if (paint_->relief && paint_->relief != height_image_) {
    for (const std::size_t tile : changedTiles(height_image_.get(), *paint_->relief)) {
      const float* values = paint_->relief->tile(tile);
      if (values == nullptr) continue;
      const auto [low, high] = std::minmax_element(values, values + kTileSide * kTileSide);
      least_ = std::min(least_, static_cast<double>(*low));
      most_ = std::max(most_, static_cast<double>(*high));
    }
    height_image_ = paint_->relief;
  }
  return {std::min(height_ * least_, height_ * most_), std::max(height_ * least_, height_ * most_)};
}

void ImageSurface::prepare(PaintQuantity quantity, vtkLookupTable* colors) {
  drawInk(quantity, colors);
  drawSlope();
  // Shine would shift colours that are read against a scale.
  const bool read = quantity == PaintQuantity::relief;
  actor_->GetProperty()->SetSpecular(read ? 0 : 0.16);
  actor_->GetProperty()->SetAmbient(read ? 0.3 : 0.16);
}

void ImageSurface::drawInk(PaintQuantity quantity, vtkLookupTable* colors) {
  const bool relief = quantity == PaintQuantity::relief;
  const Image& image = relief ? paint_->relief : paint_->color;
  const vtkMTimeType colors_time = relief ? colors->GetMTime() : 0;
  const double height = relief ? height_ : 0;
  const bool anew =
      quantity != ink_of_ || colors_time != colors_time_ || height != ink_height_ || !ink_image_;
  if (!anew && image == ink_image_) return;
  const int width = image ? image->width() : 2, rows = image ? image->height() : 2;
  if (!fits(*ink_, width, rows)) {
    ink_ = texture(width, rows, 4);
    ink_texture_->SetInputData(ink_);
  }
  auto* texels = static_cast<unsigned char*>(ink_->GetScalarPointer());
  std::array<unsigned char, 4> ground{0, 0, 0, 255};
  for (std::size_t c = 0; c < 3; ++c) ground[c] = byteOf(palette::kSurface[c]);
  if (relief) std::memcpy(ground.data(), colors->MapValue(0), 4);
  if (!image)
    for (int t = 0; t < 4; ++t) std::memcpy(texels + 4 * t, ground.data(), 4);
  else
    for (const std::size_t tile : changedTiles(anew ? nullptr : ink_image_.get(), *image)) {
      const float* value = image->tile(tile);
      const TexelBox box = boxOf(*image, tile, 0);
      for (int j = box.j0; j < box.j1; ++j) {
        unsigned char* ink =
            texels + 4 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(box.i0));
        for (int i = box.i0; i < box.i1; ++i, ink += 4) {
          if (value == nullptr) {
            std::memcpy(ink, ground.data(), 4);
          } else if (relief) {
            std::memcpy(ink, colors->MapValue(height_ * static_cast<double>(*value++)), 4);
          } else {
            const double bare = 1 - static_cast<double>(value[3]);
            for (std::size_t c = 0; c < 3; ++c)
              ink[c] = byteOf(static_cast<double>(value[c]) + bare * palette::kSurface[c]);
            ink[3] = 255;
            value += kColorChannels;
          }
        }
      }
    }
  ink_->Modified();
  ink_image_ = image;
  ink_of_ = quantity;
  ink_height_ = height;
  colors_time_ = colors_time;
}

void ImageSurface::drawSlope() {
  const Image& image = paint_->relief;
  if (!image) {
    if (slope_texture_) {
      actor_->GetProperty()->RemoveTexture(kSlopeName);
      actor_->GetShaderProperty()->ClearFragmentShaderReplacement(kNormalTag, true);
      slope_texture_ = nullptr;
      slope_ = nullptr;
      slope_image_ = nullptr;
    }
    return;
  }
  if (image == slope_image_ && height_ == slope_height_) return;
  const int width = image->width(), rows = image->height();
  if (!texels_ || texels_->width != width || texels_->height != rows)
    texels_ = std::make_shared<const TexelMap>(texelMap(*uvs_, width, rows));
  const bool fresh = !slope_ || !fits(*slope_, width, rows);
  if (fresh) {
    slope_ = texture(width, rows, 3);
    std::memset(slope_->GetScalarPointer(), encodedSlope(Vec3::Zero())[0],
                3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(rows));
  }
  const TiledImage* shown = fresh || height_ != slope_height_ ? nullptr : slope_image_.get();
  const ReliefSlope slopes(*mesh_, *uvs_, *texels_);
  auto* texels = static_cast<unsigned char*>(slope_->GetScalarPointer());
  for (const std::size_t tile : changedTiles(shown, *image)) {
    if (fresh && image->tile(tile) == nullptr) continue;
    const TexelBox box = boxOf(*image, tile, kSlopeReach);
    for (int j = box.j0; j < box.j1; ++j)
      for (int i = box.i0; i < box.i1; ++i) {
        const auto bytes = encodedSlope(height_ * slopes.at(*image, i, j));
        std::memcpy(texels + 3 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(i)),
                    bytes.data(), 3);
      }
  }
  slope_->Modified();
  slope_image_ = image;
  slope_height_ = height_;
  if (slope_texture_) {
    slope_texture_->SetInputData(slope_);
    return;
  }
  slope_texture_ = smooth(slope_);
  actor_->GetProperty()->SetTexture(kSlopeName, slope_texture_);
  actor_->GetShaderProperty()->AddFragmentShaderReplacement(kNormalTag, true, kSlopeShader, false);
}

} // namespace patina
