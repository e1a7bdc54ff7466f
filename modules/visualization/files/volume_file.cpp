#include "visualization/files/volume_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include <vtkCommand.h>
#include <vtkXMLImageDataReader.h>

#include "core/error.h"
#include "core/numbers.h"
#include "visualization/files/quiet_log.h"
#include "visualization/files/xml_tags.h"

namespace patina {
namespace {

// Collects VTK's messages. The first line is the cause; the others concern the calling filters.
class ErrorCatcher : public vtkCommand {
 public:
  static ErrorCatcher* New() { return new ErrorCatcher; }
  void Execute(vtkObject*, unsigned long, void* data) override {
    if (!cause.empty() || data == nullptr) return;
    cause = static_cast<const char*>(data);
    // Format: "ERROR: In file, line n\nvtkClass (0x..): cause\n"
    if (const auto colon = cause.find("): "); colon != std::string::npos)
      cause = cause.substr(colon + 3);
    if (const auto end = cause.find('\n'); end != std::string::npos) cause.resize(end);
  }
  std::string cause = {};
};

void checkKind(const std::filesystem::path& path) {
  std::error_code code;
  if (!std::filesystem::exists(path, code)) throw FileError(path.string(), 0, "no such file");
  if (std::filesystem::is_directory(path, code))
    throw FileError(path.string(), 0, "is a folder, not a .vti volume");
  if (!std::filesystem::is_regular_file(path, code))
    throw FileError(path.string(), 0, "is no file: a volume is not read from a pipe or device");
  std::ifstream stream(path, std::ios::binary);
  std::string head(8192, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  if (head.empty()) throw FileError(path.string(), 0, "is empty or cannot be read");
  if (head.find("<VTKFile") == std::string::npos || head.find("\"ImageData\"") == std::string::npos)
    throw FileError(path.string(), 0, "is not a VTK XML ImageData (.vti) file");
}

// Checks three numbers of the header, because VTK uses defaults for invalid ones. They may be
// absent.
void checkThree(std::string_view tag, const std::string& name, bool positive,
                const std::filesystem::path& path) {
  const std::string_view text = attributeOf(tag, name);
  if (text.data() == nullptr) return;
  std::istringstream words{std::string(text)};
  std::size_t count = 0;
  for (std::string word; words >> word; ++count)
    if (const auto number = parseNumber(word);
        !number || !std::isfinite(*number) || (positive && !(*number > 0)))
      throw FileError(path.string(), 0,
                      "has '" + word + "' in its " + name + ", which is no " +
                          (positive ? "positive " : "") + "number");
  if (count != 3)
    throw FileError(path.string(), 0,
                    "has " + std::to_string(count) + " numbers in its " + name + ", not three");
}

using Extent = std::array<double, 6>;

Extent extentOf(std::string_view tag, const std::string& name, const std::filesystem::path& path) {
  const std::string_view text = attributeOf(tag, name);
  if (text.empty()) throw FileError(path.string(), 0, "has no " + name);
  std::istringstream numbers{std::string(text)};
  Extent extent{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double &low = extent[2 * axis], &high = extent[2 * axis + 1];
    if (!(numbers >> low >> high)) high = low - 2;
    if (high < low && !(name == "Extent" && low == 0 && high == -1))
      throw FileError(path.string(), 0, "has an " + name + " that is not six ascending numbers");
  }
  return extent;
}

double nodesIn(const Extent& extent, const std::filesystem::path& path) {
  double nodes = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) nodes *= extent[2 * axis + 1] - extent[2 * axis] + 1;
  if (nodes > 1073741824.0)
    throw FileError(path.string(), 0, "has more than 2^30 nodes: resample it to a smaller grid");
  return nodes;
}

// VTK writes such pieces where a grid has fewer than are asked for.
constexpr Extent kEmpty{0, -1, 0, -1, 0, -1};

bool contains(const Extent& whole, const Extent& part) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (part[2 * axis] < whole[2 * axis] || part[2 * axis + 1] > whole[2 * axis + 1] ||
        part[2 * axis + 1] < part[2 * axis])
      return false;
  return true;
}

// Bytes that one byte of the file can stand for.
double mostExpansion(std::string_view compressor) {
  if (compressor.empty()) return 8; // text: two characters may be a number of eight bytes
  if (compressor == "vtkZLibDataCompressor") return 1100;
  return compressor == "vtkLZ4DataCompressor" ? 300 : 8000;
}

// Bytes of one value; throws for a type that VTK would not know and would read all the same.
double bytesOfType(std::string_view type, const std::filesystem::path& path) {
  constexpr std::pair<std::string_view, double> kTypes[] = {
      {"Int8", 1},  {"UInt8", 1},  {"Int16", 2},   {"UInt16", 2},  {"Int32", 4},  {"UInt32", 4},
      {"Int64", 8}, {"UInt64", 8}, {"Float32", 4}, {"Float64", 8}, {"String", 8}, {"Bit", 1}};
  for (const auto& [name, bytes] : kTypes)
    if (name == type) return bytes;
  throw FileError(path.string(), 0,
                  "cannot be read: truncated or damaged: an array of no known type");
}

// The numbers that compressed data begin with.
struct Blocks {
  std::uint64_t count = 0;
  std::uint64_t size = 0; // bytes of each when it is unpacked
  std::uint64_t last = 0; // bytes of the last one if it is shorter, otherwise 0
};

// Reads them, raw or in base64; `width`: bytes of a number.
Blocks blocksAt(const std::filesystem::path& path, std::uint64_t position, bool raw,
                std::size_t width, bool big_endian) {
  std::ifstream file(path, std::ios::binary);
  std::string text(64, '\0');
  file.seekg(static_cast<std::streamoff>(position));
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  std::string bytes;
  if (raw) {
    bytes = text;
  } else {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()))) {
      bits = bits << 6 | static_cast<std::uint32_t>(std::min<std::size_t>(kDigits.find(c), 63));
      count += 6;
      if (count < 8) continue;
      count -= 8;
      bytes += static_cast<char>(bits >> count & 0xff);
    }
  }
  bytes.resize(3 * width);
  Blocks blocks;
  std::size_t at = 0;
  for (std::uint64_t* number : {&blocks.count, &blocks.size, &blocks.last}) {
    std::string own = bytes.substr(at, width);
    at += width;
    if (big_endian) std::reverse(own.begin(), own.end());
    std::memcpy(number, own.data(), width);
  }
  return blocks;
}

// Throws if compressed data claim more blocks than the file has bytes, since the reader keeps a
// list of them, blocks of no size, by which it divides, or a last block where there is none. The
// data are found where the reader finds them: an offset wins over the format.
class BlockCheck {
 public:
  explicit BlockCheck(const std::filesystem::path& path)
      : path_(path), size_(std::filesystem::file_size(path)) {}

  void take(std::string_view tag, std::uint64_t after) {
    if (tag.starts_with("VTKFile")) {
      if (std::exchange(begun_, true)) fail("it has two roots");
      compressed_ = attributeOf(tag, "compressor").data() != nullptr;
      wide_ = attributeOf(tag, "header_type") == "UInt64";
      big_endian_ = attributeOf(tag, "byte_order") == "BigEndian";
    } else if (tag.starts_with("AppendedData")) {
      const std::uint64_t start = startOfAppended(after);
      for (const std::uint64_t offset : offsets_)
        check(start + offset, attributeOf(tag, "encoding") == "raw");
    } else if (tag.starts_with("DataArray") || tag.starts_with("Array")) {
      const std::string_view text = attributeOf(tag, "offset");
      if (text.data() == nullptr) {
        if (attributeOf(tag, "format") == "binary") check(after, false);
        return;
      }
      const double offset = parseNumber(text).value_or(-1);
      if (!(offset >= 0 && offset < static_cast<double>(size_)) || offset != std::floor(offset))
        fail("an array's offset");
      offsets_.push_back(static_cast<std::uint64_t>(offset));
    }
  }

 private:
  std::uint64_t startOfAppended(std::uint64_t after) { // behind an underscore
    std::ifstream file(path_, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(after));
    char c = ' ';
    while (std::isspace(static_cast<unsigned char>(c)) && file.get(c)) ++after;
    if (c != '_') fail("its appended data do not begin with an underscore");
    return after;
  }
  void check(std::uint64_t position, bool raw) {
    if (!compressed_) return;
    const Blocks blocks = blocksAt(path_, position, raw, wide_ ? 8 : 4, big_endian_);
    if (blocks.count > size_ || (blocks.count > 0 && blocks.size == 0) ||
        (blocks.count == 0 && blocks.last > 0))
      fail("an array's blocks");
  }
  [[noreturn]] void fail(const std::string& cause) const {
    throw FileError(path_.string(), 0, "cannot be read: truncated or damaged: " + cause);
  }

  const std::filesystem::path& path_;
  std::uint64_t size_;
  bool begun_ = false, compressed_ = false, wide_ = false, big_endian_ = false;
  std::vector<std::uint64_t> offsets_; // offsets of arrays in the appended data
};

bool isArray(std::string_view tag) {
  return tag.starts_with("DataArray") || tag.starts_with("Array");
}

// Depths of the elements that are open; -2 where there is none.
struct OpenElements {
  int piece = -2, field = -2, section = -2;

  void leave(int depth) { // a tag at this depth begins
    for (int* open : {&piece, &field, &section})
      if (depth <= *open) *open = -2;
  }
};

// Checks the header first, because the reader calls itself for nested elements and allocates what
// the header requests.
void checkHeader(const std::filesystem::path& path) {
  checkKind(path);
  double nodes = 0, expansion = 8, field_bytes = 0, piece_bytes = 0, most_bytes = 0;
  OpenElements open;
  bool has_nodes = false;
  Extent whole{};
  BlockCheck blocks(path);
  forEachTag(path, [&](std::string_view tag, std::uint64_t after, int depth) {
    blocks.take(tag, after);
    open.leave(depth);
    // The reader takes a named child of these for an array.
    const bool of_field = depth == open.field + 1;
    if (!isArray(tag) &&
        (of_field || (depth == open.section + 1 && attributeOf(tag, "Name").data() != nullptr)))
      throw FileError(path.string(), 0,
                      "cannot be read: truncated or damaged: its " +
                          std::string(of_field ? "FieldData hold no array" : "data hold no array"));
    if (tag.starts_with("FieldData")) {
      open.field = depth;
    } else if (tag.starts_with("PointData") || tag.starts_with("CellData")) {
      open.section = depth;
    } else if (tag.starts_with("VTKFile")) {
      expansion = mostExpansion(attributeOf(tag, "compressor"));
    } else if (tag.starts_with("ImageData")) {
      whole = extentOf(tag, "WholeExtent", path);
      nodes = nodesIn(whole, path);
      checkThree(tag, "Spacing", true, path);
      checkThree(tag, "Origin", false, path);
    } else if (tag.starts_with("Piece")) {
      open.piece = depth;
      const Extent part = extentOf(tag, "Extent", path);
      has_nodes = has_nodes || part != kEmpty;
      if (part != kEmpty && !contains(whole, part))
        throw FileError(path.string(), 0, "has a piece whose Extent is not in its WholeExtent");
      piece_bytes = 0;
    } else if (isArray(tag)) {
      const bool in_piece = open.piece > -2;
      const double components = parseNumber(attributeOf(tag, "NumberOfComponents")).value_or(1);
      const double tuples = parseNumber(attributeOf(tag, "NumberOfTuples")).value_or(0);
      const double bytes = (in_piece ? nodes : std::abs(tuples)) *
                           std::max(std::abs(components), 1.) *
                           bytesOfType(attributeOf(tag, "type"), path);
      (in_piece ? piece_bytes : field_bytes) += bytes;
      most_bytes = std::max(most_bytes, field_bytes + piece_bytes);
    }
  });
  if (nodes == 0) throw FileError(path.string(), 0, "has no WholeExtent");
  if (!has_nodes) throw FileError(path.string(), 0, "has no piece with an Extent of nodes");
  constexpr double kSlack = 65536;
  const auto size = static_cast<double>(std::filesystem::file_size(path));
  if (!(most_bytes <= expansion * size + kSlack))
    throw FileError(path.string(), 0,
                    "cannot be read: truncated or damaged: " + formatNumber(size) +
                        " bytes cannot hold the " + formatNumber(most_bytes) +
                        " bytes of its arrays");
}

// Runs `read` and turns the reader's messages into errors of the file.
template <typename Read>
void readQuietly(vtkXMLImageDataReader* reader, const std::filesystem::path& path,
                 const Read& read) {
  const QuietLog quiet;
  const vtkNew<ErrorCatcher> errors;
  reader->AddObserver(vtkCommand::ErrorEvent, errors);
  reader->AddObserver(vtkCommand::WarningEvent, errors);
  reader->SetFileName(path.c_str());
  try {
    // The reader creates the XML parser itself; parser errors reach the reader's error code.
    reader->SetReaderErrorObserver(errors);
    reader->SetParserErrorObserver(errors);
    read();
  } catch (const std::exception&) {
    throw FileError(path.string(), 0, "cannot be read: truncated or damaged");
  }
  if (!errors->cause.empty() || reader->GetErrorCode() != 0)
    throw FileError(path.string(), 0, "cannot be read: truncated or damaged");
}

} // namespace

vtkSmartPointer<vtkImageData> readVolume(const std::filesystem::path& path) {
  checkHeader(path);
  const vtkNew<vtkXMLImageDataReader> reader;
  readQuietly(reader, path, [&] { reader->Update(); });
  vtkSmartPointer<vtkImageData> image = reader->GetOutput();
  if (image == nullptr || image->GetNumberOfPoints() == 0)
    throw FileError(path.string(), 0, "cannot be read: truncated or damaged, or without nodes");
  return image;
}

void requireVolumeFile(const std::filesystem::path& path) {
  checkKind(path);
}

std::vector<std::string> pointArraysOf(const std::filesystem::path& path) {
  checkHeader(path);
  const vtkNew<vtkXMLImageDataReader> reader;
  readQuietly(reader, path, [&] { reader->UpdateInformation(); });
  std::vector<std::string> names;
  for (int i = 0; i < reader->GetNumberOfPointArrays(); ++i)
    names.emplace_back(reader->GetPointArrayName(i));
  return names;
}

} // namespace patina
