#include "visualization/files/vti_pieces.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <vtkNew.h>
#include <vtkZLibDataCompressor.h>

#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "visualization/files/quiet_log.h"
#include "visualization/files/xml_tags.h"

namespace patina {
namespace {

constexpr std::string_view kMark = "<!-- pieces of patina, 1 -->";
constexpr std::string_view kAppended = "<AppendedData encoding=\"raw\">\n_";
constexpr std::size_t kLongestHeader = std::size_t{1} << 28;

std::string quoted(const std::string& name, const std::string& value) {
  return " " + name + "=\"" + value + "\"";
}

template <typename List> std::string spaced(const List& values) {
  std::string text;
  for (const auto& value : values)
    text += (text.empty() ? "" : " ") + formatNumber(static_cast<double>(value));
  return text;
}

// VTK's layout of compressed bytes: number of blocks, their size, the size of a shorter last block,
// and the compressed size of each. This writes one block.
std::string compressed(std::string_view bytes) {
  const vtkNew<vtkZLibDataCompressor> zlib;
  // balance of time and memory, which holds all pieces until they are written
  zlib->SetCompressionLevel(5);
  const std::size_t room = zlib->GetMaximumCompressionSpace(bytes.size());
  std::array<std::uint64_t, 4> head{1, bytes.size(), 0, 0};
  std::string out(sizeof head + room, '\0');
  head[3] = zlib->Compress(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
                           reinterpret_cast<unsigned char*>(out.data() + sizeof head), room);
  std::memcpy(out.data(), head.data(), sizeof head);
  out.resize(sizeof head + head[3]);
  out.shrink_to_fit();
  return out;
}

template <std::size_t N> std::optional<std::array<double, N>> numbersIn(std::string_view text) {
  std::array<double, N> numbers{};
  for (std::size_t i = 0; i < N; ++i) {
    const std::size_t end = i + 1 < N ? text.find(' ') : text.size();
    if (end == std::string_view::npos) return std::nullopt;
    const auto number = parseNumber(text.substr(0, end));
    if (!number || !(std::abs(*number) < 1e300)) return std::nullopt;
    numbers[i] = *number;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return numbers;
}

} // namespace

std::string VtiWriter::stored(const VtiArray& array, std::size_t tuples) {
  std::string xml = "<DataArray" + quoted("type", array.type) + quoted("Name", array.name) +
                    quoted("NumberOfComponents", std::to_string(array.components));
  if (tuples > 0) xml += quoted("NumberOfTuples", std::to_string(tuples));
  xml += quoted("format", "appended") + quoted("offset", std::to_string(size_)) + "/>\n";
  appended_.push_back(compressed(array.bytes));
  size_ += appended_.back().size();
  return xml;
}

void VtiWriter::addFieldData(const VtiArray& array) {
  const std::size_t value = array.type.ends_with("64") ? 8 : array.type.ends_with("32") ? 4 : 1;
  field_data_ +=
      stored(array, array.bytes.size() / value / static_cast<std::size_t>(array.components));
}

void VtiWriter::addPiece(const VtiExtent& extent, const std::vector<VtiArray>& arrays,
                         const std::string& dedup_key) {
  std::string xml;
  if (const auto known = made_.find(dedup_key); known != made_.end()) xml = known->second;
  if (xml.empty())
    for (const VtiArray& array : arrays) xml += stored(array, 0);
  if (!dedup_key.empty()) made_[dedup_key] = xml;
  pieces_ += "<Piece" + quoted("Extent", spaced(extent)) + ">\n<PointData" +
             quoted("Scalars", arrays.front().name) + ">\n" + xml +
             "</PointData>\n<CellData/>\n</Piece>\n";
}

void VtiWriter::write(const std::filesystem::path& path) {
  const std::array<int, 6> whole{0, grid_.nodes[0] - 1, 0, grid_.nodes[1] - 1,
                                 0, grid_.nodes[2] - 1};
  AtomicFile file(path);
  file.append("<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
              "byte_order=\"LittleEndian\" header_type=\"UInt64\" "
              "compressor=\"vtkZLibDataCompressor\">\n" +
              std::string(kMark) + "\n<ImageData" + quoted("WholeExtent", spaced(whole)) +
              quoted("Origin", spaced(std::array<double, 3>{grid_.origin[0], grid_.origin[1],
                                                            grid_.origin[2]})) +
              quoted("Spacing",
                     spaced(std::array<double, 3>{grid_.spacing, grid_.spacing, grid_.spacing})) +
              ">\n<FieldData>\n" + field_data_ + "</FieldData>\n");
  file.append(pieces_);
  file.append("</ImageData>\n" + std::string(kAppended));
  for (; !appended_.empty(); appended_.pop_front()) file.append(appended_.front());
  file.append("\n</AppendedData>\n</VTKFile>\n");
  file.commit();
}

std::size_t VtiReader::nodesOf(const VtiExtent& extent) {
  std::size_t nodes = 1;
  for (std::size_t axis = 0; axis < 3; ++axis)
    nodes *= static_cast<std::size_t>(extent[2 * axis + 1] - extent[2 * axis] + 1);
  return nodes;
}

std::optional<VtiReader> VtiReader::open(const std::filesystem::path& path) {
  VtiReader reader(path);
  reader.file_.open(path, std::ios::binary);
  std::string header(1024, '\0');
  reader.file_.read(header.data(), static_cast<std::streamsize>(header.size()));
  header.resize(static_cast<std::size_t>(reader.file_.gcount()));
  if (header.find(kMark) == std::string::npos) return std::nullopt;
  std::size_t end = header.find(kAppended);
  while (end == std::string::npos) {
    const std::size_t before = header.size();
    header.resize(2 * before);
    reader.file_.read(header.data() + before, static_cast<std::streamsize>(before));
    header.resize(before + static_cast<std::size_t>(reader.file_.gcount()));
    end = header.find(kAppended, before - std::min(before, kAppended.size()));
    if (end == std::string::npos && (!reader.file_ || header.size() > kLongestHeader))
      throw FileError(path.string(), 0, "cannot be read: truncated or damaged");
  }
  reader.appended_ = end + kAppended.size();
  reader.file_.clear();
  reader.file_.seekg(0, std::ios::end);
  reader.size_ = static_cast<std::uint64_t>(reader.file_.tellg());
  header.resize(end);
  reader.parse(header);
  return reader;
}

void VtiReader::parse(const std::string& header) {
  const auto refuse = [&](const char* cause) {
    throw FileError(path_, 0, std::string("is damaged: ") + cause);
  };
  bool in_field_data = false;
  std::size_t end = 0;
  for (std::size_t at = header.find('<'); at != std::string::npos; at = header.find('<', end)) {
    end = header.find('>', at);
    if (end == std::string::npos) refuse("a tag has no end");
    const std::string_view tag = std::string_view(header).substr(at, end - at);
    if (tag.starts_with("<ImageData")) {
      const auto extent = numbersIn<6>(attributeOf(tag, "WholeExtent"));
      const auto origin = numbersIn<3>(attributeOf(tag, "Origin"));
      const auto spacing = numbersIn<3>(attributeOf(tag, "Spacing"));
      if (!extent || !origin || !spacing) refuse("its grid cannot be read");
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double nodes = (*extent)[2 * axis + 1] + 1;
        if ((*extent)[2 * axis] != 0 || !(nodes >= 1) || nodes > 1e6) refuse("WholeExtent");
        grid_.nodes[axis] = static_cast<int>(nodes);
        grid_.origin[static_cast<Eigen::Index>(axis)] = (*origin)[axis];
      }
      grid_.spacing = (*spacing)[0];
      if ((*spacing)[1] != grid_.spacing || (*spacing)[2] != grid_.spacing)
        refuse("its Spacing differs between axes");
    } else if (tag.starts_with("<FieldData")) {
      in_field_data = true;
    } else if (tag.starts_with("<Piece")) {
      in_field_data = false;
      const auto extent = numbersIn<6>(attributeOf(tag, "Extent"));
      if (!extent) refuse("a piece has no Extent");
      Piece& piece = pieces_.emplace_back();
      for (std::size_t i = 0; i < 6; ++i) {
        if (!((*extent)[i] >= 0 && (*extent)[i] < grid_.nodes[i / 2])) refuse("a piece's Extent");
        piece.extent[i] = static_cast<int>((*extent)[i]);
        if (i % 2 == 1 && piece.extent[i] < piece.extent[i - 1]) refuse("a piece's Extent");
      }
    } else if (tag.starts_with("<DataArray")) {
      const auto offset = parseNumber(attributeOf(tag, "offset"));
      if (!offset || !(*offset >= 0) || *offset > 1e15) refuse("an array has no offset");
      if (!in_field_data && pieces_.empty()) refuse("an array stands beside the pieces");
      Places& places = in_field_data ? field_data_ : pieces_.back().arrays;
      places[std::string(attributeOf(tag, "Name"))] = {std::string(attributeOf(tag, "type")),
                                                       static_cast<std::uint64_t>(*offset)};
    }
  }
  if (pieces_.empty()) refuse("it has no pieces");
}

bool VtiReader::hasArray(const std::string& name) const {
  return std::all_of(pieces_.begin(), pieces_.end(),
                     [&](const Piece& piece) { return piece.arrays.contains(name); });
}

void VtiReader::failAt(const std::string& array) const {
  throw FileError(path_, 0, "cannot be read: truncated or damaged: array '" + array + "'");
}

std::vector<unsigned char> VtiReader::readPacked(const Places& places, const std::string& name,
                                                 const char* type, std::size_t bytes) {
  constexpr std::uint64_t kMostExpansion = 1100; // zlib reaches 1032
  const auto place = places.find(name);
  if (place == places.end())
    throw FileError(path_, 0, "is not a Patina field: array '" + name + "' is missing");
  if (place->second.type != type) failAt(name);
  std::array<std::uint64_t, 4> head{};
  const std::uint64_t begin = appended_ + place->second.offset;
  if (begin > size_ || size_ - begin < sizeof head) failAt(name);
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(begin));
  file_.read(reinterpret_cast<char*>(head.data()), sizeof head);
  if (!file_ || head[0] != 1 || head[1] != bytes || head[2] != 0 ||
      head[3] > size_ - begin - sizeof head || bytes / kMostExpansion > head[3])
    failAt(name);
  std::vector<unsigned char> packed(head[3]);
  file_.read(reinterpret_cast<char*>(packed.data()), static_cast<std::streamsize>(packed.size()));
  if (!file_) failAt(name);
  return packed;
}

void VtiReader::unpack(const std::vector<unsigned char>& packed, const std::string& name, void* to,
                       std::size_t bytes) const {
  const QuietLog quiet;
  const vtkNew<vtkZLibDataCompressor> zlib;
  if (zlib->Uncompress(packed.data(), packed.size(), static_cast<unsigned char*>(to), bytes) !=
      bytes)
    failAt(name);
}

} // namespace patina
