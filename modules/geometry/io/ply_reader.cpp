#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/io/mesh_io.h"
#include "geometry/io/obj_materials.h"
#include "geometry/io/text_scan.h"
#include "geometry/mesh/polygon_split.h"

namespace patina {
namespace {

// The header of a PLY file.
enum class PlyFormat { ascii, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PlyTypeNames {
  const char *name, *sized_name;
  std::size_t bytes;
};
constexpr std::array<PlyTypeNames, 8> kTypes = {{{"char", "int8", 1}, // index: PlyType
                                                 {"uchar", "uint8", 1},
                                                 {"short", "int16", 2},
                                                 {"ushort", "uint16", 2},
                                                 {"int", "int32", 4},
                                                 {"uint", "uint32", 4},
                                                 {"float", "float32", 4},
                                                 {"double", "float64", 8}}};

std::size_t bytes(PlyType type) {
  return kTypes[static_cast<std::size_t>(type)].bytes;
}
bool isInteger(PlyType type) {
  return type < PlyType::float32;
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> count_type; // set for a list; always an integer type
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::size_t line = 0; // header line of the declaration
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> pictures; // names in TextureFile comments
  std::string_view body;             // data after the header
  std::size_t lines = 0;             // lines in the header
  std::size_t body_byte = 0;         // offset of the body in the file
};

// Throws FileError. An element's count never exceeds what the body can hold, so that memory may be
// reserved by it.
class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& name)
      : name_(name), bytes_(bytes),
        lines_(bytes, text::lineEndOf(bytes.substr(0, bytes.find("end_header")))) {}

  PlyHeader parse() {
    if (bytes_.empty()) throw FileError(name_, 1, "the file is empty");
    if (text::Words(nextLine()).next() != "ply") fail("not a PLY file: it must begin with 'ply'");
    bool has_format = false;
    for (;;) {
      text::Words words(nextLine());
      const std::string_view keyword = words.next();
      if (keyword == "end_header") break;
      if (keyword == "comment") addPicture(words);
      if (keyword.empty() || keyword == "comment" || keyword == "obj_info") continue;
      if (keyword == "format") {
        header_.format = format(words);
        has_format = true;
      } else if (keyword == "element") {
        addElement(words);
      } else if (keyword == "property") {
        addProperty(words);
      } else {
        fail(quotedOrBinary(keyword) + " is no statement of a PLY header");
      }
    }
    if (!has_format) fail("the header names no format");
    header_.body = lines_.rest();
    header_.lines = lines_.number();
    header_.body_byte = bytes_.size() - header_.body.size();
    checkCounts();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& cause) const {
    throw FileError(name_, lines_.number(), cause);
  }
  static std::string quotedOrBinary(std::string_view word) {
    return text::hasControl(word) ? "binary data" : text::quoted(word);
  }

  std::string_view nextLine() {
    std::string_view line;
    if (!lines_.next(line)) fail("the file ends before 'end_header'");
    return line;
  }

  PlyFormat format(text::Words& words) const {
    const std::string_view word = words.next();
    if (const std::string_view version = words.next(); version != "1.0")
      fail("PLY version " + text::quoted(version) + " is unknown; 1.0 is");
    if (word == "ascii") return PlyFormat::ascii;
    if (word == "binary_little_endian") return PlyFormat::little_endian;
    if (word == "binary_big_endian") return PlyFormat::big_endian;
    fail("format " + text::quoted(word) +
         " is unknown; ascii, binary_little_endian and binary_big_endian are");
  }

  void addPicture(text::Words& words) {
    if (!text::equalIgnoringCase(words.next(), "TextureFile")) return;
    std::string name;
    for (auto word = words.next(); !word.empty(); word = words.next())
      name += (name.empty() ? "" : " ") + std::string(word);
    if (!name.empty()) header_.pictures.push_back(name);
  }

  void addElement(text::Words& words) {
    PlyElement element;
    element.name = words.next();
    element.line = lines_.number();
    const std::string_view count = words.next();
    const auto [stop, error] =
        std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (error == std::errc::result_out_of_range)
      fail("the count " + text::quoted(count) + " is more than any file can hold");
    if (error != std::errc() || stop != count.data() + count.size())
      fail("element " + text::quoted(element.name) + " has no count but " + text::quoted(count));
    header_.elements.push_back(std::move(element));
  }

  void addProperty(text::Words& words) {
    if (header_.elements.empty()) fail("a property stands before the first element");
    PlyProperty property;
    std::string_view word = words.next();
    if (word == "list") {
      property.count_type = type(words.next());
      if (!isInteger(*property.count_type)) fail("a list's length must have an integer type");
      word = words.next();
    }
    property.type = type(word);
    property.name = words.next();
    if (property.name.empty()) fail("the property has no name");
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyType type(std::string_view word) const {
    for (std::size_t i = 0; i < kTypes.size(); ++i)
      if (word == kTypes[i].name || word == kTypes[i].sized_name) return static_cast<PlyType>(i);
    fail("type " + quotedOrBinary(word) + " is unknown");
  }

  void checkCounts() const {
    for (const PlyElement& element : header_.elements) {
      std::uint64_t smallest = 0; // bytes of one item with empty lists
      for (const PlyProperty& property : element.properties)
        smallest += header_.format == PlyFormat::ascii
                        ? 2 // a digit and a blank
                        : bytes(property.count_type.value_or(property.type));
      // The last word of an ascii file may have no blank after it.
      if (smallest > 0 && element.count > (header_.body.size() + 1) / smallest)
        throw FileError(name_, element.line,
                        "the header says " + std::to_string(element.count) + " of element " +
                            text::quoted(element.name) + ", more than the " +
                            std::to_string(header_.body.size()) + " bytes after it can hold");
    }
  }

  const std::string& name_;
  std::string_view bytes_;
  text::Lines lines_;
  PlyHeader header_;
};

// The body of an ascii or binary PLY file as a stream of numbers: beginItem, value, length and
// endItem for each item, and end.

// One item a line; blank lines are skipped.
class PlyAsciiSource {
 public:
  PlyAsciiSource(const PlyHeader& header, const std::string& name)
      : name_(name), lines_(header.body), header_lines_(header.lines) {}

  void beginItem(const PlyElement& element) {
    std::string_view line;
    do {
      if (!lines_.next(line))
        fail("the file ends where an item of element " + text::quoted(element.name) + " should be");
      words_ = text::Words(line);
      word_ = words_.next();
    } while (word_.empty());
  }
  double value(PlyType) {
    const double v = text::number(word_, name_, line(), "a property's value");
    word_ = words_.next();
    return v;
  }
  std::uint64_t length(PlyType type) {
    const double v = value(type);
    // A word takes at least a byte and a blank, so no line can hold a longer list.
    if (!(v >= 0) || v != static_cast<double>(static_cast<std::uint32_t>(std::min(v, 4e9))))
      fail("a list cannot have this length");
    return static_cast<std::uint64_t>(v);
  }
  void endItem() {
    if (!word_.empty())
      fail(text::hasControl(word_) ? "binary data where the line should end"
                                   : text::quoted(word_) + " where the line should end");
  }
  void end() {
    std::string_view line;
    while (lines_.next(line))
      if (!text::Words(line).next().empty()) fail("more lines than the header says");
  }
  [[noreturn]] void fail(const std::string& cause) const { throw FileError(name_, line(), cause); }

 private:
  std::size_t line() const { return header_lines_ + lines_.number(); }

  const std::string& name_;
  text::Lines lines_;
  std::size_t header_lines_;
  text::Words words_{{}};
  std::string_view word_;
};

template <bool big_endian> class PlyBinarySource {
 public:
  PlyBinarySource(const PlyHeader& header, const std::string& name)
      : name_(name), body_(header.body), body_byte_(header.body_byte) {}

  void beginItem(const PlyElement&) {}
  double value(PlyType type) {
    switch (type) {
    case PlyType::int8:
      return take<std::int8_t, std::uint8_t>();
    case PlyType::uint8:
      return take<std::uint8_t, std::uint8_t>();
    case PlyType::int16:
      return take<std::int16_t, std::uint16_t>();
    case PlyType::uint16:
      return take<std::uint16_t, std::uint16_t>();
    case PlyType::int32:
      return take<std::int32_t, std::uint32_t>();
    case PlyType::uint32:
      return take<std::uint32_t, std::uint32_t>();
    case PlyType::float32:
      return static_cast<double>(take<float, std::uint32_t>());
    case PlyType::float64:
      break;
    }
    return take<double, std::uint64_t>();
  }
  std::uint64_t length(PlyType type) {
    const double v = value(type);
    if (v < 0)
      fail("a list cannot have " + std::to_string(static_cast<std::int64_t>(v)) + " entries");
    return static_cast<std::uint64_t>(v);
  }
  void endItem() {}
  void end() {
    // Some programs end the file with a newline or padding; other data means that a count was
    // wrong.
    for (; at_ < body_.size(); ++at_)
      if (body_[at_] != '\0' && body_[at_] != '\n' && !text::isBlank(body_[at_]))
        fail("more data than the header says");
  }
  [[noreturn]] void fail(const std::string& cause) const {
    throw FileError(name_, 0, cause + " (byte " + std::to_string(body_byte_ + at_) + ")");
  }

 private:
  template <typename T, typename Bits> T take() {
    if (body_.size() - at_ < sizeof(Bits)) fail("the file ends within its data");
    Bits bits = 0;
    const char* from = body_.data() + at_;
    if constexpr (big_endian)
      for (std::size_t k = 0; k < sizeof(Bits); ++k)
        bits = static_cast<Bits>(bits << 7 << 1 | static_cast<unsigned char>(from[k]));
    else
      std::memcpy(&bits, from, sizeof bits); // Supported processors are little-endian.
    at_ += sizeof(Bits);
    return std::bit_cast<T>(bits);
  }

  const std::string& name_;
  std::string_view body_;
  std::size_t body_byte_;
  std::size_t at_ = 0;
};

constexpr int kUnused = -1;
constexpr int kU = 3; // roles of vertex properties: 0..2 position, 3..4 texture, 5..8 colour
constexpr int kRed = 5;
constexpr int kAlpha = 8;
constexpr int kRoles = 9;
constexpr int kIndices = 0; // roles of face properties; 5..8 colour
constexpr int kTexture = 1;
constexpr int kPicture = 2;
constexpr std::int32_t kRestart = -1; // begins the next strip in a list of strips

int colorRole(const PlyProperty& p) {
  const std::string_view name = p.name.starts_with("diffuse_") ? std::string_view(p.name).substr(8)
                                                               : std::string_view(p.name);
  for (int k = 0; k < 3; ++k)
    if (name == std::array{"red", "green", "blue"}[static_cast<std::size_t>(k)] ||
        name == std::array{"r", "g", "b"}[static_cast<std::size_t>(k)])
      return kRed + k;
  return name == "alpha" ? kAlpha : kUnused;
}

int vertexRole(const PlyProperty& p) {
  if (p.count_type) return kUnused;
  if (p.name == "x" || p.name == "y" || p.name == "z") return p.name[0] - 'x';
  if (p.name == "u" || p.name == "s" || p.name == "texture_u") return kU;
  if (p.name == "v" || p.name == "t" || p.name == "texture_v") return kU + 1;
  return colorRole(p);
}

int faceRole(const PlyProperty& p) {
  if (!p.count_type) return p.name == "texnumber" ? kPicture : colorRole(p);
  if (p.name == "vertex_indices" || p.name == "vertex_index") return kIndices;
  if (p.name == "texcoord") return kTexture;
  return kUnused;
}

using Roles = std::array<bool, kRoles>;

bool hasColor(const Roles& has) {
  return has[kRed] && has[kRed + 1] && has[kRed + 2];
}

bool hasPartOfAColor(const Roles& has) {
  return !hasColor(has) && (has[kRed] || has[kRed + 1] || has[kRed + 2]);
}

// Returns the value of a full colour in this type; 0 if the largest value in the file decides.
double whiteOf(PlyType type) {
  if (!isInteger(type)) return 0;
  return bytes(type) == 2 ? 65535 : 255;
}

template <typename Source> class PlyParser {
 public:
  PlyParser(const PlyHeader& header, const std::string& name, std::vector<std::string>* warnings,
            MeshColors* colors)
      : header_(header), name_(name), in_(header, name), warnings_(warnings), colors_(colors) {}

  TriangleMesh parse() {
    const PlyElement* vertices = element("vertex");
    if (!vertices) throw FileError(name_, header_.lines, "the header has no element 'vertex'");
    faces_ = element("face");
    strips_ = element("tristrips");
    vertex_count_ = vertices->count;
    if (vertex_count_ > std::numeric_limits<std::int32_t>::max())
      fail(*vertices, "more vertices than this program can count");
    if (countOf(faces_) + countOf(strips_) == 0) failWithoutFaces();
    Roles has_of_strips{};
    for (const PlyElement& e : header_.elements) {
      if (&e == vertices)
        readVertices(e);
      else if (&e == faces_)
        readFaces(e);
      else if (&e == strips_)
        readItems(e, faceRoles(e, "strips", has_of_strips), [&](const auto&) { addStrips(); });
      else if (!e.properties.empty())
        readItems(e, std::vector<int>(e.properties.size(), kUnused), [](const auto&) {});
    }
    in_.end();
    if (mesh_.triangles.empty()) in_.fail("the file has no triangle: its strips are too short");
    if (!face_texture_) mesh_.corner_uvs.clear();
    const PolygonFaults faults = splitPolygons(mesh_, fans_);
    if (!face_texture_ && has_vertex_texture_) gatherVertexTexture();
    const bool mapped = !mesh_.corner_uvs.empty();
    if (colors_) keepColors(mapped);
    if (warnings_) addWarnings(faults, mapped);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const PlyElement& e, const std::string& cause) const {
    throw FileError(name_, e.line, cause);
  }

  static std::uint64_t countOf(const PlyElement* e) { return e ? e->count : 0; }

  [[noreturn]] void failWithoutFaces() const {
    const std::size_t line = faces_ ? faces_->line : header_.lines;
    if (vertex_count_ == 0) throw FileError(name_, line, "the file has no face");
    throw FileError(name_, line, text::pointCloud(vertex_count_, "it has no face"));
  }

  void addWarnings(const PolygonFaults& faults, bool mapped) {
    addPolygonWarnings(faults, *warnings_);
    if (texture_lost_)
      warnings_->push_back(
          "the texture coordinates of the faces are left out: not every face has them");
    if (!colors_ && vertex_white_) warnings_->push_back(text::colorsLeftOut("vertices"));
    if (!colors_ && face_white_) warnings_->push_back(text::colorsLeftOut("faces"));
    if (has_broken_color_)
      warnings_->push_back("colours are left out that are not red, green and blue");
    if (colors_ && is_transparent_) warnings_->push_back(text::kOpaque);
    if (lost_pictures_ > 0)
      warnings_->push_back(formatCount(lost_pictures_) +
                           " triangles name a picture (texnumber) that the header does not");
    if (colors_ && mapped && header_.pictures.size() > 1 && !has_picture_numbers_)
      warnings_->push_back("of " + formatCount(header_.pictures.size()) +
                           " pictures of TextureFile only the first is shown: no face names one "
                           "by texnumber");
    if (!header_.pictures.empty() && !(colors_ && mapped))
      warnings_->push_back(
          picturesLeftOut({header_.pictures.begin(), header_.pictures.end()}, mapped));
  }

  void keepColors(bool mapped) {
    const std::size_t triangles = mesh_.triangles.size();
    if (vertex_white_) scaleColors(colors_->vertices, *vertex_white_);
    if (face_white_) {
      colors_->faces.resize(triangles); // Strips have no colours.
      scaleColors(colors_->faces, *face_white_);
    }
    if (!mapped || header_.pictures.empty()) {
      colors_->picture_of.clear();
      return;
    }
    for (const std::string& picture : header_.pictures) {
      MeshPicture& kept = colors_->pictures.emplace_back();
      kept.file = besideFile(name_, picture);
    }
    colors_->picture_of.resize(triangles, 0);
    for (std::int32_t& picture : colors_->picture_of) {
      if (picture < static_cast<std::int32_t>(colors_->pictures.size())) continue;
      picture = -1;
      ++lost_pictures_;
    }
  }

  const PlyElement* element(const char* wanted) const {
    const PlyElement* found = nullptr;
    for (const PlyElement& e : header_.elements) {
      if (e.name != wanted) continue;
      if (found) fail(e, std::string("element '") + wanted + "' appears twice");
      found = &e;
    }
    return found;
  }

  // Returns the role of each property; two properties with one role are an error.
  template <typename RoleOf>
  std::vector<int> roles(const PlyElement& e, RoleOf roleOf, Roles& claimed) const {
    std::vector<int> result;
    for (const PlyProperty& p : e.properties) {
      result.push_back(roleOf(p));
      if (result.back() == kUnused) continue;
      bool& is_claimed = claimed[static_cast<std::size_t>(result.back())];
      if (is_claimed && result.back() >= kRed)
        result.back() = kUnused; // The first of two colours counts.
      else if (is_claimed)
        fail(e, "two properties like " + text::quoted(p.name));
      else
        is_claimed = true;
    }
    return result;
  }

  // Reads every item of an element: numbers by role into an array, lists into polygon_ and
  // polygon_texture_. Calls use(numbers) for each item.
  template <typename Use>
  void readItems(const PlyElement& e, const std::vector<int>& role, Use use) {
    std::array<double, kRoles> values{};
    for (std::uint64_t i = 0; i < e.count; ++i) {
      in_.beginItem(e);
      for (std::size_t k = 0; k < role.size(); ++k) {
        const PlyProperty& p = e.properties[k];
        if (p.count_type)
          readList(p, role[k], &e == strips_);
        else if (const double value = in_.value(p.type); role[k] != kUnused)
          values[static_cast<std::size_t>(role[k])] = value;
      }
      in_.endItem();
      use(values);
    }
  }

  void readVertices(const PlyElement& e) {
    Roles has{};
    const std::vector<int> role = roles(e, vertexRole, has);
    for (std::size_t k = 0; k < 3; ++k)
      if (!has[k]) fail(e, std::string("the vertices have no property '") + "xyz"[k] + "'");
    has_vertex_texture_ = has[kU] && has[kU + 1];
    mesh_.positions.reserve(e.count);
    if (has_vertex_texture_) vertex_texture_.reserve(e.count);
    if (e.count > 0 && hasColor(has)) vertex_white_ = whiteOf(typeOf(e, role, kRed));
    has_broken_color_ |= hasPartOfAColor(has);
    const bool colored = colors_ && vertex_white_;
    if (colored) colors_->vertices.reserve(e.count);
    readItems(e, role, [&](const std::array<double, kRoles>& values) {
      mesh_.positions.emplace_back(values[0], values[1], values[2]);
      if (has_vertex_texture_) vertex_texture_.emplace_back(values[kU], values[kU + 1]);
      if (colored) colors_->vertices.push_back(colorIn(values));
      is_transparent_ |= colored && has[kAlpha] && isBelowWhite(values[kAlpha], e, role);
    });
  }

  static bool isBelowWhite(double alpha, const PlyElement& e, const std::vector<int>& role) {
    const double white = whiteOf(typeOf(e, role, kAlpha));
    return alpha < (white > 0 ? white : 1);
  }

  static PlyType typeOf(const PlyElement& e, const std::vector<int>& role, int wanted) {
    const auto found = std::find(role.begin(), role.end(), wanted);
    return e.properties[static_cast<std::size_t>(found - role.begin())].type;
  }

  static Rgba colorIn(const std::array<double, kRoles>& values) {
    return {static_cast<float>(values[kRed]), static_cast<float>(values[kRed + 1]),
            static_cast<float>(values[kRed + 2]), 1.0F};
  }

  std::vector<int> faceRoles(const PlyElement& e, const char* whose, Roles& has) const {
    const std::vector<int> role = roles(e, faceRole, has);
    if (!has[kIndices]) fail(e, std::string("the ") + whose + " have no list 'vertex_indices'");
    for (std::size_t k = 0; k < role.size(); ++k)
      if (role[k] == kIndices && !isInteger(e.properties[k].type))
        fail(e, std::string("the ") + whose + "' vertex indices must have an integer type");
    return role;
  }

  void readFaces(const PlyElement& e) {
    Roles has{};
    const std::vector<int> role = faceRoles(e, "faces", has);
    face_texture_ = has[kTexture] && countOf(strips_) == 0;
    texture_lost_ = has[kTexture] && !face_texture_;
    mesh_.triangles.reserve(e.count);
    if (face_texture_) mesh_.corner_uvs.reserve(e.count);
    if (e.count > 0 && hasColor(has)) face_white_ = whiteOf(typeOf(e, role, kRed));
    has_broken_color_ |= hasPartOfAColor(has);
    const bool colored = colors_ && face_white_, pictured = colors_ && has[kPicture];
    has_picture_numbers_ = has[kPicture];
    readItems(e, role, [&](const std::array<double, kRoles>& values) {
      const std::size_t first = mesh_.triangles.size();
      addPolygon();
      if (colored) colors_->faces.resize(first); // left without colours by strips before it
      if (colored) colors_->faces.resize(mesh_.triangles.size(), colorIn(values));
      if (pictured) colors_->picture_of.resize(first, -1);
      if (pictured)
        colors_->picture_of.resize(mesh_.triangles.size(), pictureNumber(values[kPicture]));
      is_transparent_ |= colored && has[kAlpha] && isBelowWhite(values[kAlpha], e, role);
    });
  }

  static std::int32_t pictureNumber(double number) {
    return number >= 0 && number < 1e9 ? static_cast<std::int32_t>(number) : -1;
  }

  void readList(const PlyProperty& p, int role, bool restarts) {
    if (role == kIndices) polygon_.clear();
    if (role == kTexture) polygon_texture_.clear();
    std::uint64_t n = in_.length(*p.count_type);
    if (role == kIndices)
      for (; n > 0; --n) polygon_.push_back(vertexIndex(in_.value(p.type), restarts));
    for (; n > 0; --n)
      if (const double v = in_.value(p.type); role == kTexture) polygon_texture_.push_back(v);
    if (role == kIndices && !restarts && polygon_.size() < 3)
      in_.fail("a face needs 3 corners or more, this one has " + std::to_string(polygon_.size()));
  }

  std::int32_t vertexIndex(double index, bool restarts) const {
    if ((!(index >= 0 && index < static_cast<double>(vertex_count_)) ||
         index != std::floor(index)) &&
        !(restarts && index == kRestart))
      in_.fail("the face names vertex " + formatNumber(index) + ", but the file has " +
               std::to_string(vertex_count_) + ", counted from 0");
    return static_cast<std::int32_t>(index);
  }

  // Every other triangle of a strip runs backwards. A triangle with a repeated vertex only moves
  // the strip elsewhere.
  void addStrips() {
    std::size_t first = 0;
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
      if (polygon_[i] == kRestart) first = i + 1;
      if (i < first + 2 || polygon_[i] == kRestart) continue;
      const std::int32_t a = polygon_[i - 2], b = polygon_[i - 1], c = polygon_[i];
      if (a == b || b == c || c == a) continue;
      if ((i - first) % 2 == 0)
        mesh_.triangles.push_back({a, b, c});
      else
        mesh_.triangles.push_back({b, a, c});
    }
  }

  void addPolygon() {
    // Keeps texture only if every face has it.
    if (face_texture_ && polygon_texture_.size() != 2 * polygon_.size()) {
      face_texture_ = false;
      texture_lost_ = true;
    }
    if (polygon_.size() > 3) fans_.push_back({mesh_.triangles.size(), polygon_.size()});
    const auto uv = [&](std::size_t k) {
      return Vec2(polygon_texture_[2 * k], polygon_texture_[2 * k + 1]);
    };
    for (std::size_t k = 1; k + 1 < polygon_.size(); ++k) {
      mesh_.triangles.push_back({polygon_[0], polygon_[k], polygon_[k + 1]});
      if (face_texture_) mesh_.corner_uvs.push_back({uv(0), uv(k), uv(k + 1)});
    }
  }

  void gatherVertexTexture() {
    mesh_.corner_uvs.clear();
    mesh_.corner_uvs.reserve(mesh_.triangles.size());
    for (const Triangle& t : mesh_.triangles)
      mesh_.corner_uvs.push_back({vertex_texture_[static_cast<std::size_t>(t[0])],
                                  vertex_texture_[static_cast<std::size_t>(t[1])],
                                  vertex_texture_[static_cast<std::size_t>(t[2])]});
  }

  const PlyHeader& header_;
  const std::string& name_;
  Source in_;
  std::vector<std::string>* warnings_;
  MeshColors* colors_;
  std::optional<double> vertex_white_, face_white_; // absent without colours
  bool has_broken_color_ = false, is_transparent_ = false, has_picture_numbers_ = false;
  std::size_t lost_pictures_ = 0; // triangles
  TriangleMesh mesh_;
  const PlyElement* faces_ = nullptr; // nullptr if the file has none
  const PlyElement* strips_ = nullptr;
  std::uint64_t vertex_count_ = 0;
  std::vector<std::int32_t> polygon_;
  std::vector<PolygonFan> fans_;
  std::vector<double> polygon_texture_;
  std::vector<Vec2> vertex_texture_;
  bool has_vertex_texture_ = false;
  bool face_texture_ = false;
  bool texture_lost_ = false;
};

} // namespace

TriangleMesh parsePly(std::string_view bytes, const std::string& name,
                      std::vector<std::string>* warnings, MeshColors* colors) {
  const PlyHeader header = HeaderParser(bytes, name).parse();
  if (header.format == PlyFormat::ascii)
    return PlyParser<PlyAsciiSource>(header, name, warnings, colors).parse();
  if (header.format == PlyFormat::little_endian)
    return PlyParser<PlyBinarySource<false>>(header, name, warnings, colors).parse();
  return PlyParser<PlyBinarySource<true>>(header, name, warnings, colors).parse();
}

} // namespace patina
