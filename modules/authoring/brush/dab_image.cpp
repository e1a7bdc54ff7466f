#include "authoring/brush/dab_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "authoring/brush/paint_surface.h"
#include "core/types.h"

namespace patina {
namespace {

constexpr double kNothing = 1e-6; // largest weight that the eraser may round to 0

MaterialMap mapOr(const std::shared_ptr<const MaterialMap>& map, const PaintSurface& surface,
                  const Pose& world_from_object) {
  if (map) return *map;
  const FieldGrid& grid = surface.field->grid;
  return MaterialMap(world_from_object.inverse() * grid.origin, grid.voxel);
}

double held(double value, const MaterialRange& range) {
  return std::clamp(value, range.min, range.max);
}

} // namespace

MaterialStroke::MaterialStroke(std::shared_ptr<const PaintSurface> surface, std::size_t object,
                               std::shared_ptr<const MaterialMap> start, const Material& base,
                               std::vector<MaterialInk> inks)
    : surface_(std::move(surface)), world_from_object_(surface_->objects[object].world_from_object),
      start_(mapOr(start, *surface_, world_from_object_)), map_(start_), base_(base),
      inks_(std::move(inks)) {}

std::size_t MaterialStroke::paint(const Dab& dab, const Brush& brush) {
  const Dab local = dab.in(world_from_object_.inverse()); // except for `front`
  if (brush.mode == StrokeMode::smooth && brush.tool != Tool::erase) return smooth(local, brush);
  return composite(local, brush);
}

template <typename Visit>
void MaterialStroke::forBlocks(const Dab& local, const Visit& visit) const {
  const Vec3 reach = Vec3::Constant(local.boundingRadius());
  const Vec3 low = (local.centre() - reach - map_.origin()) / (map_.voxel() * kMaterialSide);
  const Vec3 high = (local.centre() + reach - map_.origin()) / (map_.voxel() * kMaterialSide);
  const auto block = [](double x) { return static_cast<std::int32_t>(std::floor(x)); };
  for (std::int32_t z = block(low[2]); z <= block(high[2]); ++z)
    for (std::int32_t y = block(low[1]); y <= block(high[1]); ++y)
      for (std::int32_t x = block(low[0]); x <= block(high[0]); ++x) visit(Index{x, y, z});
}

// Calls visit(node, weight).
template <typename Visit>
void MaterialStroke::forNodes(const Dab& local, const Brush& brush, const Index& block,
                              const Visit& visit) const {
  for (std::size_t node = 0; node < kMaterialNodes; ++node) {
    const Vec3 place = placeOf(block, node);
    const double weight = weightAt(local, brush, place);
    if (weight > 0 && !looksAway(place, local.front)) visit(node, weight);
  }
}

Vec3 MaterialStroke::placeOf(const Index& block, std::size_t node) const {
  const Index3 at = BlockNode{block, node}.at();
  return map_.origin() + map_.voxel() * Vec3(at[0], at[1], at[2]);
}

// Contact reads no node beyond the band.
bool MaterialStroke::isNearSurface(const Index& block) const {
  const SurfaceField& field = *surface_->field;
  Box3 box;
  for (int corner = 0; corner < 8; ++corner)
    box.extend(world_from_object_ *
               placeOf(block, static_cast<std::size_t>((corner & 1) * 7 + (corner >> 1 & 1) * 56 +
                                                       (corner >> 2) * 448)));
  std::array<int, 3> low{}, high{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double side = field.grid.voxel * kBlockSide, last = field.blocks[a] - 1;
    const double slack = 1e-6; // rounding; a block that only touches its neighbour is not near
    const double from = (box.min()[axis] - field.grid.origin[axis]) / side + slack;
    const double to = (box.max()[axis] - field.grid.origin[axis]) / side - slack;
    if (!(to >= 0 && from < last + 1)) return false;
    low[a] = static_cast<int>(std::clamp(std::floor(from), 0.0, last));
    high[a] = static_cast<int>(std::clamp(std::floor(to), 0.0, last));
  }
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x)
        if (field.slotOf(x, y, z) >= 0) return true;
  return false;
}

bool MaterialStroke::looksAway(const Vec3& place, const Vec3& front) const {
  if (front.isZero(0)) return false;
  const SurfaceField& field = *surface_->field;
  const Vec3 q = field.grid.toGrid(world_from_object_ * place);
  const auto nearest = [&](int axis) { return static_cast<int>(std::lround(q[axis])); };
  const std::int32_t face = field.faceAt(nearest(0), nearest(1), nearest(2));
  return face >= 0 && faceNormal(*surface_->mesh, static_cast<std::size_t>(face)).dot(front) <= 0;
}

std::size_t MaterialStroke::composite(const Dab& local, const Brush& brush) {
  const bool erases = brush.tool == Tool::erase;
  const bool builds_up = brush.mode == StrokeMode::build_up;
  std::size_t count = 0;
  forBlocks(local, [&](const Index& block) {
    if (erases ? !map_.blocks().contains(block) : !isNearSurface(block)) return;
    Weights* greatest = nullptr;
    forNodes(local, brush, block, [&](std::size_t node, double weight) {
      ++count;
      if (!builds_up) {
        if (!greatest) greatest = &weights_[block];
        float& before = (*greatest)[node];
        if (weight <= static_cast<double>(before)) return;
        before = static_cast<float>(weight);
      }
      for (const auto& [channel, value] : inks_) {
        const MaterialLayer* under = (builds_up ? map_ : start_).layer(block, channel);
        if (erases && !under) continue;
        Pair pair;
        if (under)
          pair = {static_cast<double>(under->value[node]),
                  static_cast<double>(under->weight[node])};
        if (brush.mode == StrokeMode::add && !erases) {
          const double ground = (1 - pair.weight) * valueOf(base_, channel);
          pair.value = held(ground + pair.value + weight * value, rangeOf(channel)) - ground;
        } else {
          pair.value = (1 - weight) * pair.value + (erases ? 0 : weight * value);
          pair.weight = (1 - weight) * pair.weight + (erases ? 0 : weight);
          const bool nothing = pair.weight < kNothing && std::abs(pair.value) < kNothing;
          if (erases && nothing) pair = {};
        }
        set(block, node, channel, pair);
      }
    });
  });
  return count;
}

std::size_t MaterialStroke::smooth(const Dab& local, const Brush& brush) {
  struct Place {
    Index block;
    std::size_t node;
    MaterialChannel channel;
    Pair pair;
  };
  std::vector<Place> places; // written at the end, because means use the values before the dab
  std::size_t count = 0;
  forBlocks(local, [&](const Index& block) {
    if (!isNearSurface(block)) return;
    forNodes(local, brush, block, [&](std::size_t node, double weight) {
      ++count;
      const Index3 at = BlockNode{block, node}.at();
      for (const MaterialInk& ink : inks_) {
        const MaterialChannel channel = ink.channel;
        Pair mean;
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (const int step : {-1, 1}) {
            Index3 beside = at;
            beside[axis] += step;
            const Pair pair = pairAt(beside, channel);
            mean.value += pair.value / 6;
            mean.weight += pair.weight / 6;
          }
        Pair pair = pairAt(at, channel);
        pair.value += weight * (mean.value - pair.value);
        pair.weight += weight * (mean.weight - pair.weight);
        places.push_back({block, node, channel, pair});
      }
    });
  });
  for (const Place& place : places) set(place.block, place.node, place.channel, place.pair);
  return count;
}

MaterialStroke::Pair MaterialStroke::pairAt(const std::array<std::int32_t, 3>& node,
                                            MaterialChannel channel) const {
  const auto [block, n] = BlockNode::of(node);
  const MaterialLayer* layer = map_.layer(block, channel);
  if (!layer) return {};
  return {static_cast<double>(layer->value[n]), static_cast<double>(layer->weight[n])};
}

void MaterialStroke::set(const Index& block, std::size_t node, MaterialChannel channel,
                         const Pair& pair) {
  const auto value = static_cast<float>(pair.value), weight = static_cast<float>(pair.weight);
  const MaterialLayer* before = map_.layer(block, channel);
  // A layer stays shared, or missing, until a value in it changes.
  if ((before ? before->value[node] : 0.0f) == value &&
      (before ? before->weight[node] : 0.0f) == weight)
    return;
  MaterialLayer& layer = map_.writable(block, channel);
  layer.value[node] = value;
  layer.weight[node] = weight;
  changed_ = true;
  written_.insert(block);
}

std::shared_ptr<const MaterialMap> MaterialStroke::take() {
  changed_ = false;
  if (map_.blocks().empty()) return nullptr;
  return std::make_shared<const MaterialMap>(map_.published());
}

void MaterialStroke::dropEmpty() {
  map_.dropEmptyLayers();
  changed_ = true;
}

std::vector<MaterialMap::Index> MaterialStroke::takeBlocks() {
  std::vector<Index> blocks(written_.begin(), written_.end());
  written_.clear();
  return blocks;
}

namespace {

// Positions of one object's texels on the surface.
struct TexelPlace {
  Vec3 point = Vec3::Zero(); // [m], world
  bool inside = true;        // false: a gutter texel, which repeats its face's edge
};

// One face of an object with the data for its texels.
class FaceTexels {
 public:
  // face: in the combined mesh.
  FaceTexels(const PaintSurface& surface, const PaintObject& object, std::int32_t face);

  TexelPlace at(int i, int j) const;
  // Calls visit(i, j) for the face's own texels that may show a point within `radius` of `centre`.
  template <typename Visit>
  void forNear(const Vec3& centre, double radius, const Visit& visit) const {
    const TexelBox box =
        texelsNear(corners_, *uv_, centre, radius, texels_->width, texels_->height);
    for (int j = box.j0; j < box.j1; ++j)
      for (int i = box.i0; i < box.i1; ++i)
        if (texels_->ownerAt(i, j) == local_) visit(i, j);
  }
  Vec3 normal() const; // unit; zero without area
  // Returns the largest distance of neighbouring texels in the face's plane [m].
  double footprint() const;

 private:
  std::array<Vec3, 3> corners_; // world
  const std::array<Vec2, 3>* uv_;
  const TexelMap* texels_;
  std::int32_t local_; // index in the object's own mesh
};

FaceTexels::FaceTexels(const PaintSurface& surface, const PaintObject& object, std::int32_t face)
    : texels_(object.texels.get()), local_(face - object.first_face) {
  for (int k = 0; k < 3; ++k)
    corners_[static_cast<std::size_t>(k)] = surface.mesh->corner(static_cast<std::size_t>(face), k);
  uv_ = &(*object.layout.uvs)[static_cast<std::size_t>(local_)];
}

TexelPlace FaceTexels::at(int i, int j) const {
  const Vec2 centre((i + 0.5) / texels_->width, (j + 0.5) / texels_->height);
  const Vec3 w = texelBarycentric(*uv_, centre.x(), centre.y());
  TexelPlace place;
  place.point = w[0] * corners_[0] + w[1] * corners_[1] + w[2] * corners_[2];
  const Vec2 shown = w[0] * (*uv_)[0] + w[1] * (*uv_)[1] + w[2] * (*uv_)[2];
  place.inside = (shown - centre).cwiseAbs().maxCoeff() < 1e-9;
  return place;
}

Vec3 FaceTexels::normal() const {
  const Vec3 across = (corners_[1] - corners_[0]).cross(corners_[2] - corners_[0]);
  const double length = across.norm();
  return length > 0 ? Vec3(across / length) : Vec3::Zero();
}

double FaceTexels::footprint() const {
  const Vec3 e1 = corners_[1] - corners_[0], e2 = corners_[2] - corners_[0];
  const double longest = std::max({e1.norm(), e2.norm(), (e2 - e1).norm()});
  const Vec2 d1 = (*uv_)[1] - (*uv_)[0], d2 = (*uv_)[2] - (*uv_)[0];
  const double det = d1.x() * d2.y() - d1.y() * d2.x();
  // Derivatives along u and v by a texel, a step of 1 / width or 1 / height.
  const Vec3 along_u = (e1 * d2.y() - e2 * d1.y()) / (det * texels_->width);
  const Vec3 along_v = (e2 * d1.x() - e1 * d2.x()) / (det * texels_->height);
  const double step = std::hypot(along_u.norm(), along_v.norm());
  return std::isfinite(step) ? step : longest;
}

// Averages texels over their neighbours on the surface, across chart borders.
struct NearTexel {
  Vec3 point = Vec3::Zero();  // [m]
  Vec3 normal = Vec3::Zero(); // face normal; zero without area
  double footprint = 0;       // [m], distance to its neighbours in the image
  bool inside = true;         // false: repeats an edge in a gutter and is ignored by others
  std::array<double, 4> values{};
};

constexpr double kNear = 1.5;      // [footprints]
constexpr std::int64_t kReach = 3; // [cells], bounds the time for uneven maps

struct Cell {
  std::int64_t x, y, z;
};

// Points in the cells of a cubic lattice, sorted so that a row along x is contiguous.
class Cells {
 public:
  Cells(const std::vector<NearTexel>& texels, double side) : side_(side) {
    Box3 box;
    for (const NearTexel& texel : texels) box.extend(texel.point);
    origin_ = box.min();
    for (std::size_t n = 0; n < texels.size(); ++n)
      if (texels[n].inside) entries_.push_back({key(cellOf(texels[n].point)), n});
    std::sort(entries_.begin(), entries_.end());
  }

  Cell cellOf(const Vec3& p) const {
    const Vec3 q = ((p - origin_) / side_).cwiseMin(1e6);
    return {static_cast<std::int64_t>(q[0]), static_cast<std::int64_t>(q[1]),
            static_cast<std::int64_t>(q[2])};
  }
  template <typename Visit> void forRow(Cell from, std::int64_t to_x, const Visit& visit) const {
    if (from.y < 0 || from.z < 0) return;
    const std::uint64_t last = key({to_x, from.y, from.z});
    from.x = std::max<std::int64_t>(from.x, 0);
    auto entry = std::lower_bound(entries_.begin(), entries_.end(), Entry{key(from), 0});
    for (; entry != entries_.end() && entry->key <= last; ++entry) visit(entry->texel);
  }

 private:
  struct Entry {
    std::uint64_t key;
    std::size_t texel;
    auto operator<=>(const Entry&) const = default;
  };
  static std::uint64_t key(const Cell& c) {
    return static_cast<std::uint64_t>(c.z << 42 | c.y << 21 | c.x);
  }
  double side_;
  Vec3 origin_;
  std::vector<Entry> entries_;
};

double cellSide(const std::vector<NearTexel>& texels) {
  std::vector<double> footprints;
  for (const NearTexel& texel : texels) footprints.push_back(texel.footprint);
  const auto low = footprints.begin() + static_cast<std::ptrdiff_t>(footprints.size() / 10);
  std::nth_element(footprints.begin(), low, footprints.end());
  return kNear * *low;
}

// Returns for each texel the mean over the others within 1.5 footprints that face the same way, or
// its own values without any. Searches in space, which crosses seams but not thin walls. O(n log n)
// for footprints of similar size.
std::vector<std::array<double, 4>> meansOfNeighbours(const std::vector<NearTexel>& texels) {
  std::vector<std::array<double, 4>> means(texels.size());
  for (std::size_t n = 0; n < texels.size(); ++n) means[n] = texels[n].values;
  if (texels.empty()) return means;
  const double side = cellSide(texels);
  if (!(side > 0)) return means;
  const Cells cells(texels, side);
  for (std::size_t n = 0; n < texels.size(); ++n) {
    const NearTexel& texel = texels[n];
    const double radius = kNear * texel.footprint;
    const auto span = std::min(kReach, static_cast<std::int64_t>(std::ceil(radius / side)));
    const Cell cell = cells.cellOf(texel.point);
    std::array<double, 4> sum{};
    int count = 0;
    for (std::int64_t z = cell.z - span; z <= cell.z + span; ++z)
      for (std::int64_t y = cell.y - span; y <= cell.y + span; ++y)
        cells.forRow({cell.x - span, y, z}, cell.x + span, [&](std::size_t m) {
          const NearTexel& other = texels[m];
          if (m == n || (other.point - texel.point).squaredNorm() > radius * radius ||
              other.normal.dot(texel.normal) < 0)
            return;
          for (std::size_t c = 0; c < 4; ++c) sum[c] += other.values[c];
          ++count;
        });
    for (std::size_t c = 0; c < 4 && count > 0; ++c) means[n][c] = sum[c] / count;
  }
  return means;
}

constexpr double kInvisible = 1e-6; // smaller values are erased completely

TiledImage copyOr(const std::shared_ptr<const TiledImage>& image, const TexelMap& texels,
                  int channels) {
  return image ? *image : TiledImage(texels.width, texels.height, channels);
}

bool isEmpty(const TiledImage& image) {
  for (std::size_t t = 0; t < image.tileCount(); ++t)
    if (image.tile(t)) return false;
  return true;
}

} // namespace

ImageStroke::ImageStroke(std::shared_ptr<const PaintSurface> surface, std::size_t object,
                         std::shared_ptr<const TiledImage> start, int channels, const Ink& ink)
    : surface_(std::move(surface)), object_(&surface_->objects[object]), start_(std::move(start)),
      image_(copyOr(start_, *object_->texels, channels)),
      weights_(object_->texels->width, object_->texels->height, 1), ink_(ink) {}

std::size_t ImageStroke::paint(const Dab& dab, const Brush& brush,
                               std::span<const std::int32_t> faces) {
  if (brush.mode == StrokeMode::smooth && !ink_.erases) return smooth(dab, brush, faces);
  const Vec3 centre = dab.centre();
  const double reach = dab.boundingRadius();
  std::size_t count = 0;
  for (const std::int32_t face : faces) {
    const FaceTexels texels(*surface_, *object_, face);
    texels.forNear(centre, reach, [&](int i, int j) {
      const Vec3 point = texels.at(i, j).point;
      const double weight = weightAt(dab, brush, point);
      if (!(weight > 0)) return;
      ++count;
      composite(texelAt(i, j), weight, brush.mode);
    });
  }
  return count;
}

ImageStroke::Texel ImageStroke::texelAt(int i, int j) const {
  return {image_.tileOf(i, j), image_.offsetOf(i, j)};
}

void ImageStroke::composite(const Texel& texel, double weight, StrokeMode mode) {
  std::array<double, 4> under{};
  if (mode == StrokeMode::build_up) {
    under = valuesIn(&image_, texel);
  } else {
    const std::size_t at = texel.offset / static_cast<std::size_t>(image_.channels());
    const float* before = weights_.tile(texel.tile);
    if (before && weight <= static_cast<double>(before[at])) return;
    weights_.writable(texel.tile)[at] = static_cast<float>(weight);
    under = valuesIn(start_.get(), texel);
  }
  const bool adds = mode == StrokeMode::add && !ink_.erases;
  for (std::size_t c = 0; c < 4; ++c) {
    under[c] = (adds ? 1 : 1 - weight) * under[c] + (ink_.erases ? 0 : weight * ink_.value[c]);
    if (ink_.erases && std::abs(under[c]) < kInvisible) under[c] = 0;
  }
  set(texel, under);
}

std::array<double, 4> ImageStroke::valuesIn(const TiledImage* image, const Texel& texel) const {
  std::array<double, 4> values{};
  const float* tile = image ? image->tile(texel.tile) : nullptr;
  if (!tile) return values;
  for (std::size_t c = 0; c < static_cast<std::size_t>(image_.channels()); ++c)
    values[c] = static_cast<double>(tile[texel.offset + c]);
  return values;
}

void ImageStroke::set(const Texel& texel, const std::array<double, 4>& values) {
  const auto channels = static_cast<std::size_t>(image_.channels());
  std::array<float, 4> rounded{};
  for (std::size_t c = 0; c < channels; ++c) rounded[c] = static_cast<float>(values[c]);
  static constexpr std::array<float, 4> kNothing{};
  const float* tile = image_.tile(texel.tile);
  const float* before = tile ? tile + texel.offset : kNothing.data();
  // A tile stays shared, or missing, until a value in it changes.
  if (std::equal(rounded.begin(), rounded.begin() + image_.channels(), before)) return;
  std::copy_n(rounded.begin(), channels, image_.writable(texel.tile) + texel.offset);
  changed_ = true;
  written_ = true;
}

std::size_t ImageStroke::smooth(const Dab& dab, const Brush& brush,
                                std::span<const std::int32_t> faces) {
  struct Place {
    Texel texel;
    double weight;
  };
  std::vector<Place> places;
  std::vector<NearTexel> near;
  const Vec3 centre = dab.centre();
  const double reach = dab.boundingRadius();
  for (const std::int32_t face : faces) {
    const FaceTexels texels(*surface_, *object_, face);
    const double footprint = texels.footprint();
    const Vec3 normal = texels.normal();
    texels.forNear(centre, reach, [&](int i, int j) {
      const TexelPlace place = texels.at(i, j);
      const Texel texel = texelAt(i, j);
      places.push_back({texel, weightAt(dab, brush, place.point)});
      near.push_back({place.point, normal, footprint, place.inside, valuesIn(&image_, texel)});
    });
  }
  const std::vector<std::array<double, 4>> means = meansOfNeighbours(near);
  std::size_t count = 0;
  for (std::size_t n = 0; n < places.size(); ++n) {
    const double w = places[n].weight;
    if (!(w > 0)) continue;
    ++count;
    std::array<double, 4> values = near[n].values;
    for (std::size_t c = 0; c < 4; ++c) values[c] += w * (means[n][c] - values[c]);
    set(places[n].texel, values);
  }
  return count;
}

std::shared_ptr<const TiledImage> ImageStroke::take() {
  changed_ = false;
  if (isEmpty(image_)) return nullptr;
  return std::make_shared<const TiledImage>(image_.published());
}

void ImageStroke::dropEmpty() {
  image_.dropEmptyTiles();
  changed_ = true;
}

bool ImageStroke::takeWritten() {
  return std::exchange(written_, false);
}

} // namespace patina
