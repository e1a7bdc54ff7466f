#include "visualization/files/field_io.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkSignedCharArray.h>
#include <vtkSmartPointer.h>

#include "core/error.h"
#include "core/types.h"
#include "visualization/files/volume_file.h"
#include "visualization/files/vti_pieces.h"

namespace patina {
namespace {

constexpr const char* kPhi = "phi [m]";
constexpr const char* kRounding = "phi rounding [ulp]";
constexpr const char* kFace = "face";
constexpr const char* kGrid = "grid [m]";
constexpr const char* kBand = "band [voxel]";
constexpr const char* kCoarse = "coarse [voxel]";
constexpr signed char kBeyond = 127;

float metres(float voxels, double voxel) {
  return static_cast<float>(static_cast<double>(voxels) * voxel);
}
float voxels(float metres, double voxel) {
  return static_cast<float>(static_cast<double>(metres) / voxel);
}

// Floats of one sign are ordered as their bit patterns, so one ulp is a difference of one.
int ulpsBetween(float from, float to) {
  return static_cast<int>(std::bit_cast<std::uint32_t>(to) - std::bit_cast<std::uint32_t>(from));
}
float stepped(float value, int ulps) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) +
                              static_cast<std::uint32_t>(ulps));
}

template <typename Array, typename Data>
Array* requireArray(Data* data, const char* name, vtkIdType values,
                    const std::filesystem::path& path) {
  auto* array = Array::SafeDownCast(data->GetAbstractArray(name));
  if (array == nullptr)
    throw FileError(path.string(), 0,
                    std::string("is not a Patina field: array '") + name + "' is missing");
  if (values >= 0 && array->GetNumberOfValues() != values)
    throw FileError(path.string(), 0,
                    std::string("is not a Patina field: array '") + name + "' has a wrong size");
  return array;
}

// Compares origin and spacing with the exact numbers: a difference means that the file was moved or
// scaled.
FieldGrid gridOf(const std::array<int, 3>& nodes, const double* exact, const Vec3& origin,
                 const Vec3& spacing, const std::filesystem::path& path) {
  FieldGrid grid;
  grid.nodes = nodes;
  for (int axis = 0; axis < 3; ++axis) {
    grid.origin[axis] = exact[axis];
    if (nodes[static_cast<std::size_t>(axis)] < 2)
      throw FileError(path.string(), 0, "is not a Patina field: fewer than two nodes on an axis");
  }
  grid.voxel = exact[3];
  if (!grid.origin.allFinite() || !std::isfinite(grid.voxel) || grid.voxel <= 0)
    throw FileError(path.string(), 0, "is not a Patina field: its voxel is not a positive length");
  constexpr double kPrinted = 1e-4; // VTK prints only some digits
  const double origin_off = (origin - grid.origin).cwiseAbs().maxCoeff();
  if (!(origin_off <= kPrinted * (grid.voxel + grid.origin.cwiseAbs().maxCoeff())))
    throw FileError(path.string(), 0,
                    "its Origin was changed: it is not that of 'grid [m]'; move the mesh instead");
  if (!((spacing - Vec3::Constant(grid.voxel)).cwiseAbs().maxCoeff() <= kPrinted * grid.voxel))
    throw FileError(
        path.string(), 0,
        "its Spacing was changed: it is not that of 'grid [m]'; scale the mesh instead");
  return grid;
}

// Nodes of a part of the grid, or of the whole grid.
struct NodesRead {
  VtiExtent extent{};
  const float* phi = nullptr;
  const signed char* rounding = nullptr;
  const std::int32_t* face = nullptr; // null if there is none
};

// Reads one block of the file; a block without nodes in the band is not stored.
struct BlockReader {
  const std::filesystem::path& path;
  const FieldGrid& grid;
  const NodesRead& nodes; // all nodes of the block
  std::array<int, 3> first{};

  std::size_t at(int i, int j, int k) const {
    const VtiExtent& e = nodes.extent;
    const auto nx = static_cast<std::size_t>(e[1] - e[0] + 1),
               ny = static_cast<std::size_t>(e[3] - e[2] + 1);
    return (static_cast<std::size_t>(k - e[4]) * ny + static_cast<std::size_t>(j - e[2])) * nx +
           static_cast<std::size_t>(i - e[0]);
  }

  // Returns false if every node is beyond the band; `inside` is then their common sign.
  bool read(DistanceNodes& distance, FaceNodes& faces, bool& inside) const {
    bool stored = false;
    std::size_t n = 0;
    for (int k = first[2]; k < first[2] + kBlockSide; ++k)
      for (int j = first[1]; j < first[1] + kBlockSide; ++j)
        for (int i = first[0]; i < first[0] + kBlockSide; ++i, ++n) {
          distance.phi[n] = kBackground;
          faces.face[n] = -1;
          if (i >= grid.nodes[0] || j >= grid.nodes[1] || k >= grid.nodes[2]) continue;
          const std::size_t node = at(i, j, k);
          if (!std::isfinite(nodes.phi[node]))
            throw FileError(path.string(), 0, "is damaged: a distance is not a number");
          if (nodes.rounding[node] == kBeyond) {
            inside = nodes.phi[node] < 0;
            distance.phi[n] = inside ? -kBackground : kBackground;
            continue;
          }
          distance.phi[n] = stepped(voxels(nodes.phi[node], grid.voxel), nodes.rounding[node]);
          if (!(std::abs(distance.phi[n]) < kBackground))
            throw FileError(path.string(), 0, "is damaged: a distance is beyond any band");
          if (nodes.face != nullptr) faces.face[n] = nodes.face[node];
          stored = true;
        }
    return stored;
  }
};

// Blocks in reading order, then in the order of the field.
class BlockList {
 public:
  explicit BlockList(SurfaceField& field) : field_(field) {
    std::size_t count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      field.blocks[axis] = (field.grid.nodes[axis] + kBlockSide - 1) / kBlockSide;
      count *= static_cast<std::size_t>(field.blocks[axis]);
    }
    field.block_index.assign(count, SurfaceField::kOutside);
  }

  void take(const std::filesystem::path& path, const NodesRead& nodes) {
    const VtiExtent& e = nodes.extent;
    BlockReader reader{path, field_.grid, nodes, {}};
    for (int bz = e[4] / kBlockSide; bz * kBlockSide <= e[5]; ++bz)
      for (int by = e[2] / kBlockSide; by * kBlockSide <= e[3]; ++by)
        for (int bx = e[0] / kBlockSide; bx * kBlockSide <= e[1]; ++bx) {
          reader.first = {bx * kBlockSide, by * kBlockSide, bz * kBlockSide};
          const std::size_t at =
              static_cast<std::size_t>((bz * field_.blocks[1] + by) * field_.blocks[0] + bx);
          DistanceNodes distance;
          FaceNodes faces{};
          bool inside = false;
          if (!reader.read(distance, faces, inside)) {
            field_.block_index[at] = inside ? SurfaceField::kInside : SurfaceField::kOutside;
            continue;
          }
          found_.push_back({at,
                            {bx, by, bz},
                            std::make_shared<const DistanceBlock>(distance),
                            nodes.face ? std::make_shared<const FaceBlock>(faces) : nullptr});
        }
  }

  void finish() {
    std::sort(found_.begin(), found_.end(),
              [](const Found& a, const Found& b) { return a.at < b.at; });
    for (Found& block : found_) {
      field_.block_index[block.at] = static_cast<std::int32_t>(field_.block_at.size());
      field_.block_at.push_back(block.block);
      field_.distance.push_back(std::move(block.distance));
      if (block.face) field_.face.push_back(std::move(block.face));
    }
  }

 private:
  struct Found {
    std::size_t at;
    std::array<std::int32_t, 3> block;
    std::shared_ptr<const DistanceBlock> distance;
    std::shared_ptr<const FaceBlock> face;
  };
  SurfaceField& field_;
  std::vector<Found> found_;
};

void setBand(SurfaceField& field, double band, const std::filesystem::path& path) {
  field.band = band;
  if (!std::isfinite(field.band) || field.band <= 0)
    throw FileError(path.string(), 0, "is not a Patina field: its band is not a positive number");
}

void setCoarse(SurfaceField& field, const float* values, const std::filesystem::path& path) {
  if (!std::all_of(values, values + 4 * field.coarse.size(),
                   [](float value) { return std::isfinite(value); }))
    throw FileError(path.string(), 0, "is damaged: a coarse distance is not a number");
  std::memcpy(field.coarse.data(), values, field.coarse.size() * sizeof(CoarseNode));
}

std::size_t coarseCount(const SurfaceField& field) {
  std::size_t nodes = 1;
  for (const int blocks : field.blocks) nodes *= static_cast<std::size_t>(blocks + 1);
  return nodes;
}

// Pieces of the file: whole blocks, a fixed number per side.
constexpr int kSide = 8 * kBlockSide;
double pieceCount(const std::array<int, 3>& nodes) {
  double count = 1;
  for (const int along : nodes) count *= std::ceil(along / static_cast<double>(kSide));
  return count;
}
std::vector<VtiExtent> piecesOf(const std::array<int, 3>& nodes) {
  std::vector<VtiExtent> pieces;
  for (int z = 0; z < nodes[2]; z += kSide)
    for (int y = 0; y < nodes[1]; y += kSide)
      for (int x = 0; x < nodes[0]; x += kSide)
        pieces.push_back({x, std::min(x + kSide, nodes[0]) - 1, y,
                          std::min(y + kSide, nodes[1]) - 1, z, std::min(z + kSide, nodes[2]) - 1});
  return pieces;
}

struct PieceNodes {
  std::vector<float> phi;
  std::vector<signed char> rounding;
  std::vector<std::int32_t> face;
};

// Fills the nodes of a piece. Returns false if none is stored and all lie on one side.
bool fill(PieceNodes& nodes, const SurfaceField& field, const VtiExtent& e) {
  const float band = static_cast<float>(field.band * field.grid.voxel);
  const bool has_face = !field.face.empty();
  std::size_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis)
    count *= static_cast<std::size_t>(e[2 * axis + 1] - e[2 * axis] + 1);
  nodes.phi.resize(count);
  nodes.rounding.resize(count);
  nodes.face.resize(has_face ? count : 0);
  bool any = false, in = false, out = false;
  const NodesRead shape{e, nullptr, nullptr, nullptr};
  for (int bz = e[4] / kBlockSide; bz * kBlockSide <= e[5]; ++bz)
    for (int by = e[2] / kBlockSide; by * kBlockSide <= e[3]; ++by)
      for (int bx = e[0] / kBlockSide; bx * kBlockSide <= e[1]; ++bx) {
        const std::int32_t slot = field.slotOf(bx, by, bz);
        const BlockReader place{
            {}, field.grid, shape, {bx * kBlockSide, by * kBlockSide, bz * kBlockSide}};
        DistanceNodes block;
        if (slot >= 0)
          field.distance[static_cast<std::size_t>(slot)]->unpack(block);
        else
          block.phi.fill(backgroundOf(slot));
        const auto& first = place.first;
        std::size_t n = 0;
        for (int k = first[2]; k < first[2] + kBlockSide; ++k)
          for (int j = first[1]; j < first[1] + kBlockSide; ++j)
            for (int i = first[0]; i < first[0] + kBlockSide; ++i, ++n) {
              if (i > e[1] || j > e[3] || k > e[5]) continue;
              const float value = block.phi[n];
              const std::size_t node = place.at(i, j, k);
              const bool beyond = std::abs(value) >= kBackground;
              any |= !beyond;
              (value < 0 ? in : out) = true;
              if (has_face) nodes.face[node] = beyond ? -1 : field.faceAt(i, j, k);
              const float written =
                  beyond ? std::copysign(band, value) : metres(value, field.grid.voxel);
              nodes.phi[node] = written;
              nodes.rounding[node] = beyond ? kBeyond
                                            : static_cast<signed char>(ulpsBetween(
                                                  voxels(written, field.grid.voxel), value));
            }
      }
  return any || in == out;
}

template <typename T> std::string_view bytesOf(const T* values, std::size_t count) {
  return {reinterpret_cast<const char*>(values), count * sizeof(T)};
}

SurfaceField readPieces(VtiReader& file, const std::filesystem::path& path) {
  SurfaceField field;
  std::vector<double> exact;
  file.readFieldData(kGrid, 4, exact);
  field.grid = gridOf(file.grid().nodes, exact.data(), file.grid().origin,
                      Vec3::Constant(file.grid().spacing), path);
  std::vector<double> band;
  file.readFieldData(kBand, 1, band);
  setBand(field, band[0], path);
  if (pieceCount(field.grid.nodes) != static_cast<double>(file.pieces()))
    throw FileError(path.string(), 0, "is damaged: its pieces are not those of its grid");
  const std::vector<VtiExtent> pieces = piecesOf(field.grid.nodes);
  BlockList blocks(field);
  PieceNodes nodes;
  const bool has_face = file.hasArray(kFace);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (file.extent(i) != pieces[i])
      throw FileError(path.string(), 0, "is damaged: its pieces are not those of its grid");
    file.readArray(i, kPhi, nodes.phi);
    file.readArray(i, kRounding, nodes.rounding);
    if (has_face) file.readArray(i, kFace, nodes.face);
    blocks.take(path, {pieces[i], nodes.phi.data(), nodes.rounding.data(),
                       has_face ? nodes.face.data() : nullptr});
  }
  blocks.finish();
  if (!file.hasFieldData(kCoarse)) return field;
  std::vector<float> coarse;
  file.readFieldData(kCoarse, 4 * coarseCount(field), coarse);
  field.coarse.resize(coarseCount(field));
  setCoarse(field, coarse.data(), path);
  return field;
}

SurfaceField readWhole(const std::filesystem::path& path) {
  const vtkSmartPointer<vtkImageData> image = readVolume(path);
  const vtkIdType count = image->GetNumberOfPoints();
  auto* points = image->GetPointData();
  vtkFieldData* data = image->GetFieldData();
  SurfaceField field;
  const int* nodes = image->GetDimensions();
  field.grid = gridOf({nodes[0], nodes[1], nodes[2]},
                      requireArray<vtkDoubleArray>(data, kGrid, 4, path)->GetPointer(0),
                      Vec3(image->GetOrigin()), Vec3(image->GetSpacing()), path);
  setBand(field, requireArray<vtkDoubleArray>(data, kBand, 1, path)->GetValue(0), path);
  const bool has_face = points->HasArray(kFace) != 0;
  BlockList blocks(field);
  blocks.take(
      path,
      {{0, nodes[0] - 1, 0, nodes[1] - 1, 0, nodes[2] - 1},
       requireArray<vtkFloatArray>(points, kPhi, count, path)->GetPointer(0),
       requireArray<vtkSignedCharArray>(points, kRounding, count, path)->GetPointer(0),
       has_face ? requireArray<vtkIntArray>(points, kFace, count, path)->GetPointer(0) : nullptr});
  blocks.finish();
  if (data->HasArray(kCoarse) == 0) return field;
  field.coarse.resize(coarseCount(field));
  const auto values = static_cast<vtkIdType>(4 * field.coarse.size());
  setCoarse(field, requireArray<vtkFloatArray>(data, kCoarse, values, path)->GetPointer(0), path);
  return field;
}

} // namespace

void writeField(const std::filesystem::path& path, const SurfaceField& field) {
  const FieldGrid& grid = field.grid;
  const bool has_face = !field.face.empty();
  VtiWriter file({grid.nodes, grid.origin, grid.voxel});
  const std::array<double, 4> exact{grid.origin[0], grid.origin[1], grid.origin[2], grid.voxel};
  file.addFieldData({kGrid, "Float64", 4, bytesOf(exact.data(), exact.size())});
  file.addFieldData({kBand, "Float64", 1, bytesOf(&field.band, 1)});
  if (!field.coarse.empty())
    file.addFieldData({kCoarse, "Float32", 4, bytesOf(field.coarse.data(), field.coarse.size())});
  PieceNodes nodes;
  for (const VtiExtent& piece : piecesOf(grid.nodes)) {
    const bool stored = fill(nodes, field, piece);
    const std::size_t count = nodes.phi.size();
    std::vector<VtiArray> arrays = {{kPhi, "Float32", 1, bytesOf(nodes.phi.data(), count)},
                                    {kRounding, "Int8", 1, bytesOf(nodes.rounding.data(), count)}};
    if (has_face) arrays.push_back({kFace, "Int32", 1, bytesOf(nodes.face.data(), count)});
    // Pieces beyond the band differ only in side and number of nodes.
    file.addPiece(piece, arrays,
                  stored ? ""
                         : (nodes.phi[0] < 0 ? "inside " : "outside ") + std::to_string(count));
  }
  file.write(path);
}

SurfaceField readField(const std::filesystem::path& path) {
  requireVolumeFile(path);
  auto pieces = VtiReader::open(path);
  return pieces ? readPieces(*pieces, path) : readWhole(path);
}

bool isField(const std::filesystem::path& path) {
  requireVolumeFile(path);
  if (const auto pieces = VtiReader::open(path))
    return pieces->hasFieldData(kGrid) && pieces->hasArray(kPhi) && pieces->hasArray(kRounding);
  const std::vector<std::string> names = pointArraysOf(path);
  const auto has = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  return has(kPhi) && has(kRounding);
}

} // namespace patina
