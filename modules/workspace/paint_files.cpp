#include "workspace/paint_files.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/json.h"
#include "pictures/image_library.h"

namespace patina {
namespace {

// Visits the rows of allocated tiles; the others stay 0.
template <typename Visit> void forEachRow(const TiledImage& image, const Visit& visit) {
  const auto channels = static_cast<std::size_t>(image.channels());
  const std::size_t width = static_cast<std::size_t>(image.width()) * channels;
  const auto height = static_cast<std::size_t>(image.height());
  const auto across = static_cast<std::size_t>(image.tilesAcross());
  constexpr auto kSide = static_cast<std::size_t>(kTileSide);
  for (std::size_t index = 0; index < image.tileCount(); ++index) {
    for (std::size_t row = 0; row < kSide; ++row) {
      const std::size_t from_top = height - 1 - (index / across * kSide + row);
      visit(index, row * kSide * channels, from_top * width + index % across * kSide * channels,
            kSide * channels);
    }
  }
}

} // namespace

std::string exrBytes(const TiledImage& image) {
  ImageRows rows{image.width(), image.height(), image.channels(), {}, false};
  rows.value.assign(rows.rowSize() * static_cast<std::size_t>(rows.height), 0.0f);
  forEachRow(image, [&](std::size_t tile, std::size_t from, std::size_t to, std::size_t size) {
    if (const float* values = image.tile(tile))
      std::copy_n(values + from, size, rows.value.data() + to);
  });
  requireFinite(rows, "image");
  std::string bytes;
  const std::string cause = imageLibrary("image").write_exr(rows, bytes);
  if (!cause.empty()) throw Error("an image cannot be stored: " + cause);
  return bytes;
}

TiledImage parseExr(std::string_view bytes, int channels, const std::string& name) {
  if (bytes.empty()) throw FileError(name, 0, "the file is empty");
  ImageRows rows;
  const ImageLimits limits{kMaxImage, std::size_t{kMaxImage} * kMaxImage * 4, 5};
  const std::string cause = imageLibrary(name).read_exr(bytes, limits, rows);
  if (!cause.empty()) throw FileError(name, 0, "cannot be read as an EXR image: " + cause);
  const auto fits = [](int side) { return side >= kMinImage && side % kTileSide == 0; };
  if (rows.channels != channels || !fits(rows.width) || !fits(rows.height)) {
    throw FileError(name, 0,
                    "is not a painted image: " + std::to_string(rows.width) + " x " +
                        std::to_string(rows.height) + " texels of " +
                        std::to_string(rows.channels) + " channels where " +
                        std::to_string(channels) + " and multiples of " +
                        std::to_string(kTileSide) + " were expected");
  }
  requireFinite(rows, name);
  TiledImage image(rows.width, rows.height, channels);
  forEachRow(image, [&](std::size_t tile, std::size_t to, std::size_t from, std::size_t size) {
    const float* row = rows.value.data() + from;
    const bool any =
        std::any_of(row, row + size, [](float v) { return v != 0 || std::signbit(v); });
    if (any) std::copy_n(row, size, image.writable(tile) + to);
  });
  return image;
}

namespace {

constexpr std::int64_t kVersion = 1;
// Node indices of a block farther out would not fit into 32 bits.
constexpr std::int32_t kFarthest = (1 << 28) - 1;
// Max of the box around all blocks, from which a dense table is made for haptics.
constexpr double kMaxBlocks = 1 << 24;
constexpr std::size_t kMaxHeader = 65536;

struct BlockBox {
  MaterialMap::Index least{kFarthest, kFarthest, kFarthest};
  MaterialMap::Index most{-kFarthest, -kFarthest, -kFarthest};
  void add(const MaterialMap::Index& index) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], index[axis]);
      most[axis] = std::max(most[axis], index[axis]);
    }
  }
  bool isTooLarge() const {
    double blocks = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
      blocks *= std::max(0.0, 1.0 + double(most[axis]) - double(least[axis]));
    return blocks > kMaxBlocks;
  }
};

bool isFinite(const MaterialLayer& layer) {
  const auto finite = [](float v) { return std::isfinite(v); };
  return std::all_of(layer.value.begin(), layer.value.end(), finite) &&
         std::all_of(layer.weight.begin(), layer.weight.end(), finite);
}

template <typename T> void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Reads header and blocks; every step checks the remaining size.
class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  MaterialMap map() {
    const Json header = headerLine();
    std::optional<MaterialMap> map;
    try {
      map = empty(header);
    } catch (const FileError&) {
      throw;
    } catch (const Error& error) {
      throw FileError(name_, 1, error.what());
    }
    std::optional<MaterialMap::Index> last;
    BlockBox box;
    for (std::uint64_t i = 0; i < count_; ++i) {
      const auto index = take<MaterialMap::Index>();
      for (const std::int32_t at : index)
        if (at < -kFarthest || at > kFarthest) fail("a block lies outside the supported range");
      if (last && !(*last < index)) fail("blocks are out of order");
      box.add(index);
      if (box.isTooLarge()) fail("the blocks span too large a box");
      last = index;
      readBlock(*map, index);
    }
    if (at_ != bytes_.size()) fail("more data than the header says");
    return std::move(*map);
  }

 private:
  [[noreturn]] void fail(const std::string& cause) const {
    throw FileError(name_, 0, cause + " (byte " + std::to_string(at_) + ")");
  }

  Json headerLine() {
    const std::size_t end = bytes_.substr(0, kMaxHeader).find('\n');
    if (end == std::string_view::npos) throw FileError(name_, 1, "is not a painted material");
    at_ = end + 1;
    return parseJson(bytes_.substr(0, end), name_);
  }

  MaterialMap empty(const Json& header) {
    if (header.at("format").asString() != "patina material")
      throw Error("is not a painted material");
    if (const std::int64_t version = header.at("version").asInteger(); version != kVersion)
      throw Error("painted material of version " + std::to_string(version) + " is unknown");
    for (const Json& channel : header.at("channels").asArray())
      channels_.push_back(channelNamed(channel.at("name").asString()));
    if (channels_.size() > kMaterialChannels) throw Error("a channel occurs twice");
    const std::int64_t count = header.at("blocks").asInteger();
    const std::uint64_t smallest = sizeof(MaterialMap::Index) + sizeof(std::uint32_t);
    if (count < 0 || static_cast<std::uint64_t>(count) > (bytes_.size() - at_) / smallest)
      throw Error("the header says " + std::to_string(count) + " blocks, more than the file holds");
    count_ = static_cast<std::uint64_t>(count);
    const Json::Array& origin = header.at("origin").asArray();
    if (origin.size() != 3) throw Error("'origin' must be 3 numbers");
    const Vec3 corner(origin[0].asNumber(), origin[1].asNumber(), origin[2].asNumber());
    const double voxel = header.at("voxel").asNumber();
    if (!corner.allFinite() || !(voxel > 0) || !std::isfinite(voxel))
      throw Error("'origin' and 'voxel' do not define a grid");
    return {corner, voxel};
  }

  static MaterialChannel channelNamed(const std::string& wanted) {
    for (const MaterialChannel channel : kAllMaterialChannels)
      if (name(channel) == wanted) return channel;
    throw Error("channel '" + wanted + "' is unknown");
  }

  void readBlock(MaterialMap& map, const MaterialMap::Index& index) {
    const auto mask = take<std::uint32_t>();
    if (mask >> channels_.size() != 0)
      fail("a block holds a channel that the header does not name");
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      if (!(mask >> c & 1)) continue;
      // The size is checked before memory is allocated.
      const auto layer = take<MaterialLayer>();
      if (!isFinite(layer)) fail("a value is not a finite number");
      map.writable(index, channels_[c]) = layer;
    }
  }

  template <typename T> T take() {
    if (bytes_.size() - at_ < sizeof(T)) fail("the file ends within its data");
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
  std::uint64_t count_ = 0;
  std::vector<MaterialChannel> channels_;
};

} // namespace

std::string materialBytes(const MaterialMap& map) {
  BlockBox box;
  for (const auto& [index, block] : map.blocks()) box.add(index);
  if (box.isTooLarge()) throw Error("painted material spans too large a box");
  Json channels = Json::array();
  for (const MaterialChannel channel : kAllMaterialChannels) {
    Json json = Json::object();
    json.set("name", name(channel)).set("unit", unit(channel));
    channels.push(std::move(json));
  }
  Json origin = Json::array();
  for (int axis = 0; axis < 3; ++axis) origin.push(map.origin()[axis]);
  Json header = Json::object();
  header.set("format", "patina material").set("version", kVersion).set("units", "SI");
  header.set("origin", std::move(origin)).set("voxel", map.voxel());
  header.set("channels", std::move(channels)).set("blocks", map.blocks().size());
  std::string bytes = header.dump(-1) + "\n";
  bytes.reserve(bytes.size() + map.bytes());
  for (const auto& [index, block] : map.blocks()) {
    append(bytes, index);
    std::uint32_t mask = 0;
    for (std::size_t c = 0; c < kMaterialChannels; ++c)
      if (block.layer[c]) mask |= 1u << c;
    append(bytes, mask);
    for (const auto& layer : block.layer) {
      if (!layer) continue;
      if (!isFinite(*layer)) throw Error("painted material holds a value that is not finite");
      append(bytes, *layer);
    }
  }
  return bytes;
}

MaterialMap parseMaterial(std::string_view bytes, const std::string& name) {
  return Reader(bytes, name).map();
}

} // namespace patina
