// Writes and reads a VTK XML image (.vti) one piece at a time. Internal to field_io.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.h"

namespace patina {

// Grid of the image. ParaView shows it as one image or piece by piece. Equal pieces are in the file
// once.
struct VtiGrid {
  std::array<int, 3> nodes{};
  Vec3 origin = Vec3::Zero(); // in the file's numbers
  double spacing = 0;
};

using VtiExtent = std::array<int, 6>; // first and last node along x, y, z

struct VtiArray {
  std::string name, type; // "Float32", "Int8", "Int32", "Float64"
  int components = 1;
  std::string_view bytes; // all values
};

// Compresses pieces in memory as they are added; write() writes the whole file.
class VtiWriter {
 public:
  explicit VtiWriter(const VtiGrid& grid) : grid_(grid) {}

  void addFieldData(const VtiArray& array);
  // Pieces tile the grid and have the same arrays; readers get them in this order. A piece with the
  // `dedup_key` of an earlier piece has the same content as that one; "": no key.
  void addPiece(const VtiExtent& extent, const std::vector<VtiArray>& arrays,
                const std::string& dedup_key = "");
  void write(const std::filesystem::path& path); // throws FileError; call once

 private:
  std::string stored(const VtiArray& array, std::size_t tuples);

  VtiGrid grid_;
  std::string field_data_, pieces_;         // XML
  std::map<std::string, std::string> made_; // key: `dedup_key`; XML of the arrays
  std::deque<std::string> appended_;
  std::uint64_t size_ = 0;
};

// Reads files of VtiWriter with one array in memory at a time. All functions throw FileError.
class VtiReader {
 public:
  // Returns nullopt for a .vti of another program.
  static std::optional<VtiReader> open(const std::filesystem::path& path);

  const VtiGrid& grid() const { return grid_; }
  std::size_t pieces() const { return pieces_.size(); }
  const VtiExtent& extent(std::size_t piece) const { return pieces_[piece].extent; }
  bool hasFieldData(const std::string& name) const { return field_data_.contains(name); }
  bool hasArray(const std::string& name) const;

  // Fills `values`; the array must have this type and `count` values.
  template <typename T>
  void readFieldData(const std::string& name, std::size_t count, std::vector<T>& values) {
    read(field_data_, name, count, values);
  }
  template <typename T>
  void readArray(std::size_t piece, const std::string& name, std::vector<T>& values) {
    read(pieces_[piece].arrays, name, nodesOf(pieces_[piece].extent), values);
  }

 private:
  struct Place {
    std::string type;
    std::uint64_t offset = 0;
  };
  using Places = std::map<std::string, Place>;
  struct Piece {
    VtiExtent extent{};
    Places arrays;
  };

  explicit VtiReader(const std::filesystem::path& path) : path_(path.string()) {}
  void parse(const std::string& header);
  template <typename T>
  void read(const Places& places, const std::string& name, std::size_t count,
            std::vector<T>& values) {
    const auto packed = readPacked(places, name, typeOf(values.data()), count * sizeof(T));
    values.resize(count);
    unpack(packed, name, values.data(), count * sizeof(T));
  }
  // Returns the compressed bytes of an array; they are enough for `bytes`.
  std::vector<unsigned char> readPacked(const Places& places, const std::string& name,
                                        const char* type, std::size_t bytes);
  void unpack(const std::vector<unsigned char>& packed, const std::string& name, void* to,
              std::size_t bytes) const;
  [[noreturn]] void failAt(const std::string& array) const;
  static const char* typeOf(const float*) { return "Float32"; }
  static const char* typeOf(const double*) { return "Float64"; }
  static const char* typeOf(const std::int32_t*) { return "Int32"; }
  static const char* typeOf(const signed char*) { return "Int8"; }
  static std::size_t nodesOf(const VtiExtent& extent);

  std::string path_;
  std::ifstream file_;
  std::uint64_t appended_ = 0, size_ = 0; // offset of the appended bytes; file size
  VtiGrid grid_;
  Places field_data_;
  std::vector<Piece> pieces_;
};

} // namespace patina
