#include "visualization/layers/image_surface.h"

#include <algorithm>
#include <cstring>

#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkProperty.h>
#include <vtkShaderProperty.h>

#include "scene/relief_slope.h"
#include "visualization/surfaces/refined_surface.h"
#include "visualization/surfaces/surface_data.h"

namespace patina {
namespace {

// Max edge length. A brush covers several voxels, so linear interpolation at this size is accurate;
// finer triangles would take too long per frame with software OpenGL.
constexpr double kEdgeVoxels = 2;
constexpr std::size_t kMaxShown = 150'000;

// The value of a node extends one voxel to each side.
Box3 reachOf(const MaterialMap& map, const MaterialMap::Index& block) {
  const Vec3 first(kMaterialSide * block[0], kMaterialSide * block[1], kMaterialSide * block[2]);
  return Box3(map.origin() + map.voxel() * (first - Vec3::Ones()),
              map.origin() + map.voxel() * (first + Vec3::Constant(kMaterialSide)));
}

// Shades relief by tilting the normal as its displacement would: n - grad h. Decodes
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

std::optional<std::vector<Box3>> changedPlaces(const MaterialMap* before, const MaterialMap& now,
                                               MaterialChannel channel) {
  if (before == nullptr || before->origin() != now.origin() || before->voxel() != now.voxel())
    return std::nullopt;
  std::vector<Box3> places;
  const auto c = static_cast<std::size_t>(channel);
  const auto check = [&](const MaterialMap& these, const MaterialMap& others, bool both) {
    for (const auto& [index, block] : these.blocks()) {
      const MaterialLayer* other = others.layer(index, channel);
      if (block.layer[c].get() == other || (other != nullptr && !both)) continue;
      places.push_back(reachOf(now, index));
    }
  };
  check(now, *before, true);
  check(*before, now, false); // blocks that were removed
  return places;
}

MaterialSurface::MaterialSurface() : actor_(surfaceActor(palette::kSurface)) {
  vtkPolyDataMapper& mapper = mapperOf(*actor_);
  mapper.ScalarVisibilityOn();
  mapper.UseLookupTableScalarRangeOn();
  mapper.InterpolateScalarsBeforeMappingOn();
  // Specular light would change colours that are read against a scale.
  actor_->GetProperty()->SetSpecular(0);
  actor_->GetProperty()->SetAmbient(0.3);
}

void MaterialSurface::set(const SceneObject& object, const Material& base) {
  if (object.mesh != mesh_) {
    mesh_ = object.mesh;
    fineness_ = 0;
  }
  map_ = object.paint->material;
  base_ = base;
  place(*actor_, object.world_from_object);
}

ValueRange MaterialSurface::prepare(MaterialChannel channel) {
  const double base = valueOf(base_, channel);
  if (fineness_ != map_->voxel()) {
    fineness_ = map_->voxel();
    const RefinedSurface fine = refined(*mesh_, kEdgeVoxels * fineness_, kMaxShown);
    std::vector<std::int32_t> vertex;
    const auto data = surfaceData(fine.mesh, fine.normals, vertex);
    points_.clear();
    for (const std::int32_t v : vertex)
      points_.push_back(fine.mesh.positions[static_cast<std::size_t>(v)]);
    const vtkNew<vtkFloatArray> values;
    values->SetNumberOfValues(static_cast<vtkIdType>(points_.size()));
    data->GetPointData()->SetScalars(values);
    mapperOf(*actor_).SetInputData(data);
    shown_ = nullptr;
  }
  const bool same_kind = shown_ != nullptr && channel_ == channel && shown_base_ == base;
  if (same_kind && shown_ == map_) return range_;
  const auto places = same_kind ? changedPlaces(shown_.get(), *map_, channel) : std::nullopt;
  if (!same_kind) range_ = {base, base};
  evaluate(channel, places ? &*places : nullptr);
  shown_ = map_;
  channel_ = channel;
  shown_base_ = base;
  return range_;
}

std::vector<float> MaterialSurface::values() const {
  const auto* values =
      vtkFloatArray::SafeDownCast(mapperOf(*actor_).GetInput()->GetPointData()->GetScalars());
  const float* first = const_cast<vtkFloatArray*>(values)->GetPointer(0);
  return {first, first + points_.size()};
}

void MaterialSurface::evaluate(MaterialChannel channel, const std::vector<Box3>* places) {
  Box3 all;
  if (places != nullptr)
    for (const Box3& place : *places) all.extend(place);
  auto* values =
      vtkFloatArray::SafeDownCast(mapperOf(*actor_).GetInput()->GetPointData()->GetScalars());
  for (std::size_t p = 0; p < points_.size(); ++p) {
    if (places != nullptr && (!all.contains(points_[p]) ||
                              std::none_of(places->begin(), places->end(), [&](const Box3& place) {
                                return place.contains(points_[p]);
                              })))
      continue;
    const double value = valueOf(map_->at(points_[p], base_), channel);
    range_ = {std::min(range_.low, value), std::max(range_.high, value)};
    values->SetValue(static_cast<vtkIdType>(p), static_cast<float>(value));
  }
  values->Modified();
  mapperOf(*actor_).GetInput()->Modified();
}

std::vector<std::size_t> changedTiles(const TiledImage* before, const TiledImage& now) {
  std::vector<std::size_t> tiles;
  const bool same_size = before != nullptr && before->width() == now.width() &&
                         before->height() == now.height() && before->channels() == now.channels();
  for (std::size_t tile = 0; tile < now.tileCount(); ++tile)
    if (!same_size || before->tile(tile) != now.tile(tile)) tiles.push_back(tile);
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
  property->SetColor(1, 1, 1); // the texture contains the object's own colour
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
    mapperOf(*actor_).SetInputData(texturedData(*mesh_, *uvs_));
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
  // Specular light would change colours that are read against a scale.
  const bool read = quantity == PaintQuantity::relief;
  actor_->GetProperty()->SetSpecular(read ? 0 : 0.16);
  actor_->GetProperty()->SetAmbient(read ? 0.3 : 0.16);
}

void ImageSurface::drawInk(PaintQuantity quantity, vtkLookupTable* colors) {
  const bool relief = quantity == PaintQuantity::relief;
  const Image& image = relief ? paint_->relief : paint_->color;
  const vtkMTimeType colors_time = relief ? colors->GetMTime() : 0;
  const double height = relief ? height_ : 0;
  const bool is_outdated =
      quantity != ink_of_ || colors_time != colors_time_ || height != ink_height_ || !ink_image_;
  if (!is_outdated && image == ink_image_) return;
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
    for (const std::size_t tile : changedTiles(is_outdated ? nullptr : ink_image_.get(), *image)) {
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
