// A VTK XML image (.vti) in pieces, written and read one piece at a time: ParaView shows it as one
// image, or some of its pieces. Equal pieces are in the file once.
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

struct VtiGrid {
  std::array<int, 3> nodes{};
  Vec3 origin = Vec3::Zero(); // as the numbers in the file
  double spacing = 0;
};

using VtiExtent = std::array<int, 6>; // first and last node along x, y, z

struct VtiArray {
  std::string name, type; // "Float32", "Int8", "Int32", "Float64"
  int components = 1;
  std::string_view bytes; // of all values
};

// Compressed in memory as they are given; the file is then written at once, from its start.
class VtiWriter {
 public:
  explicit VtiWriter(const VtiGrid& grid) : grid_(grid) {}

  void addFieldData(const VtiArray& array);
  // In the order in which readers find them; all with the same arrays. The pieces tile the grid.
  // `alike`, if not empty: the same as any earlier piece that was given that name.
  void addPiece(const VtiExtent& extent, const std::vector<VtiArray>& arrays,
                const std::string& alike = "");
  void write(const std::filesystem::path& path); // FileError; once

 private:
  std::string stored(const VtiArray& array, std::size_t tuples);

  VtiGrid grid_;
  std::string field_data_, pieces_;         // XML
  std::map<std::string, std::string> made_; // XML of the arrays, by `alike`
  std::deque<std::string> appended_;
  std::uint64_t size_ = 0;
};

// Reads what VtiWriter wrote. All throw FileError; nothing larger than one array is in memory.
class VtiReader {
 public:
  // Nothing if the file is another's .vti.
  static std::optional<VtiReader> open(const std::filesystem::path& path);

  const VtiGrid& grid() const { return grid_; }
  std::size_t pieces() const { return pieces_.size(); }
  const VtiExtent& extent(std::size_t piece) const { return pieces_[piece].extent; }
  bool hasFieldData(const std::string& name) const { return field_data_.contains(name); }
  bool hasArray(const std::string& name) const;

  // `values` get the array, which must be of that type and have so many values.
  template <typename T>
  void readFieldData(const std::string& name, std::size_t count, std::vector<T>& values) {
    values.resize(count);
    read(field_data_, name, typeOf(values.data()), values.data(), count * sizeof(T));
  }
  template <typename T>
  void readArray(std::size_t piece, const std::string& name, std::vector<T>& values) {
    values.resize(nodesOf(pieces_[piece].extent));
    read(pieces_[piece].arrays, name, typeOf(values.data()), values.data(),
         values.size() * sizeof(T));
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
  void read(const Places& places, const std::string& name, const char* type, void* to,
            std::size_t bytes);
  static const char* typeOf(const float*) { return "Float32"; }
  static const char* typeOf(const double*) { return "Float64"; }
  static const char* typeOf(const std::int32_t*) { return "Int32"; }
  static const char* typeOf(const signed char*) { return "Int8"; }
  static std::size_t nodesOf(const VtiExtent& extent);

  std::string path_;
  std::ifstream file_;
  std::uint64_t appended_ = 0, size_ = 0; // where the appended bytes begin; of the file
  VtiGrid grid_;
  Places field_data_;
  std::vector<Piece> pieces_;
};

} // namespace patina
