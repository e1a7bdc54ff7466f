#include "geometry/io/ply_header.h"

#include <array>
#include <charconv>

#include "geometry/io/text_scan.h"

namespace patina {
namespace {

struct TypeName {
  const char* name;
  PlyType type;
};
constexpr std::array<TypeName, 16> kTypeNames = {{{"char", PlyType::int8},
                                                  {"int8", PlyType::int8},
                                                  {"uchar", PlyType::uint8},
                                                  {"uint8", PlyType::uint8},
                                                  {"short", PlyType::int16},
                                                  {"int16", PlyType::int16},
                                                  {"ushort", PlyType::uint16},
                                                  {"uint16", PlyType::uint16},
                                                  {"int", PlyType::int32},
                                                  {"int32", PlyType::int32},
                                                  {"uint", PlyType::uint32},
                                                  {"uint32", PlyType::uint32},
                                                  {"float", PlyType::float32},
                                                  {"float32", PlyType::float32},
                                                  {"double", PlyType::float64},
                                                  {"float64", PlyType::float64}}};

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
    for (const TypeName& known : kTypeNames)
      if (word == known.name) return known.type;
    fail("type " + quotedOrBinary(word) + " is unknown");
  }

  void checkCounts() const {
    for (const PlyElement& element : header_.elements) {
      std::uint64_t smallest = 0; // bytes of one item with empty lists
      for (const PlyProperty& property : element.properties)
        smallest += header_.format == PlyFormat::ascii
                        ? 2 // a digit and a blank
                        : bytes(property.count_type.value_or(property.type));
      // The last word of an ascii file may lack its blank.
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

} // namespace

std::size_t bytes(PlyType type) {
  switch (type) {
  case PlyType::int8:
  case PlyType::uint8:
    return 1;
  case PlyType::int16:
  case PlyType::uint16:
    return 2;
  case PlyType::int32:
  case PlyType::uint32:
  case PlyType::float32:
    return 4;
  case PlyType::float64:
    break;
  }
  return 8;
}

PlyHeader parsePlyHeader(std::string_view bytes, const std::string& name) {
  return HeaderParser(bytes, name).parse();
}

} // namespace patina
