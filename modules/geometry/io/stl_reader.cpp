#include <cstring>

#include "geometry/io/mesh_io.h"
#include "geometry/io/text_scan.h"
#include "geometry/mesh/vertex_weld.h"

namespace patina {
namespace {

constexpr std::size_t kHeader = 84;       // 80 free bytes, then the count
constexpr unsigned char kOwnColor = 0x80; // VisCAM: a facet has its own colour
constexpr std::size_t kRecord = 50;       // normal, three corners (floats), two free bytes
constexpr std::uint32_t kUnknownCount = 0xffffffff; // written by programs that cannot seek

template <typename T> T littleEndian(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value); // Supported processors are little-endian.
  return value;
}

std::uint64_t binarySize(std::string_view bytes) {
  return kHeader + std::uint64_t{littleEndian<std::uint32_t>(bytes.data() + 80)} * kRecord;
}

enum class Kind { binary, ascii, other_text };

// Determines the kind by size, then by content, since a binary header may begin with "solid" too.
Kind kindOf(std::string_view bytes) {
  if (bytes.size() >= kHeader && binarySize(bytes) == bytes.size()) return Kind::binary;
  if (text::hasControl(bytes.substr(0, kHeader))) return Kind::binary;
  text::Lines lines(withoutByteOrderMark(bytes));
  std::string_view line;
  std::string_view word;
  while (word.empty() && lines.next(line)) word = text::Words(line).next();
  if (text::equalIgnoringCase(word, "solid")) return Kind::ascii;
  return text::hasControl(bytes.substr(0, kHeader + kRecord)) ? Kind::binary : Kind::other_text;
}

std::string bytesText(std::size_t count) {
  return formatCount(count) + (count == 1 ? " byte" : " bytes");
}

TriangleMesh parseBinary(std::string_view bytes, const std::string& name,
                         std::vector<std::string>& warnings) {
  if (bytes.size() < kHeader)
    throw FileError(name, 0,
                    "not an STL file: it has " + std::to_string(bytes.size()) +
                        " bytes, fewer than a binary header");
  std::size_t count = littleEndian<std::uint32_t>(bytes.data() + 80);
  const std::size_t fitting = (bytes.size() - kHeader) / kRecord;
  if (const bool streamed = count == 0 || count == kUnknownCount; streamed && fitting > 0) {
    warnings.push_back("the header says " + formatCount(count) + " triangles; the " +
                       bytesText(bytes.size() - kHeader) + " after it are read as " +
                       formatCount(fitting));
    count = fitting;
  }
  if (count > fitting)
    throw FileError(name, 0,
                    "the header at byte 80 says " + std::to_string(count) + " triangles (" +
                        std::to_string(binarySize(bytes)) + " bytes), but the file has " +
                        std::to_string(bytes.size()) + " bytes");
  if (count == 0) throw FileError(name, 0, "the file has no triangle (count at byte 80)");
  if (const std::size_t left = bytes.size() - kHeader - count * kRecord; left > 0)
    warnings.push_back(bytesText(left) + " after the last triangle: left out" +
                       (left < kRecord ? std::string()
                                       : ", though they could be " + formatCount(left / kRecord) +
                                             " triangles more than the header says"));
  bool colored = bytes.substr(0, 80).find("COLOR=") != bytes.npos; // written by Magics
  TriangleMesh mesh;
  mesh.triangles.resize(count);
  VertexWeld weld(count / 2 + 3);
  for (std::size_t t = 0; t < count; ++t) {
    const char* corner = bytes.data() + kHeader + t * kRecord + 12;
    for (std::size_t k = 0; k < 3; ++k, corner += 12)
      mesh.triangles[t][k] =
          weld.index(Vec3(littleEndian<float>(corner), littleEndian<float>(corner + 4),
                          littleEndian<float>(corner + 8)));
    colored = colored || (static_cast<unsigned char>(corner[1]) & kOwnColor) != 0;
  }
  if (colored) warnings.push_back(text::colorsLeftOut("triangles"));
  mesh.positions = weld.takePoints();
  return mesh;
}

class AsciiParser {
 public:
  AsciiParser(std::string_view bytes, const std::string& name, std::vector<std::string>& warnings)
      : name_(name), lines_(bytes), weld_(bytes.size() / 500), warnings_(warnings) {}

  TriangleMesh parse() {
    while (findWord()) {
      if (!triangles_.empty() && !text::equalIgnoringCase(word_, "solid")) {
        warnings_.push_back("line " + std::to_string(lines_.number()) +
                            ": what follows the last solid is left out");
        break;
      }
      expect("solid");
      skipName("facet normal");
      while (nextIsFacet()) readFacet();
      skipName("solid ");
    }
    if (triangles_.empty()) throw FileError(name_, lines_.number(), "the file has no triangle");
    if (colored_) warnings_.push_back(text::colorsLeftOut("triangles"));
    TriangleMesh mesh;
    mesh.triangles = std::move(triangles_);
    mesh.positions = weld_.takePoints();
    return mesh;
  }

 private:
  bool findWord() {
    for (;;) {
      word_ = words_.next();
      if (!word_.empty()) return true;
      if (!lines_.next(line_)) return false;
      words_ = text::Words(line_);
    }
  }
  // Skips the solid's name: the rest of the line, or up to `next` if the whole file is one line.
  void skipName(std::string_view next) {
    const auto from = static_cast<std::size_t>(word_.data() + word_.size() - line_.data());
    const bool goes_on = line_.find("facet normal", from) != line_.npos;
    words_ = text::Words(goes_on ? line_.substr(std::min(line_.find(next, from), line_.size()))
                                 : std::string_view());
  }
  void nextWord(const char* wanted) {
    do {
      if (!findWord())
        throw FileError(name_, lines_.number(),
                        std::string("the file ends where ") + wanted + " should be");
    } while (skipsColor());
  }
  bool skipsColor() { // a separate line, by Magics
    const bool skips = (word_[0] | 0x20) == 'c' && text::equalIgnoringCase(word_, "color");
    if (skips) words_ = text::Words({});
    colored_ = colored_ || skips;
    return skips;
  }
  void expect(const char* wanted) {
    if (word_ != wanted && !text::equalIgnoringCase(word_, wanted)) throwUnexpected(wanted);
  }
  void nextMustBe(const char* wanted) {
    nextWord(wanted);
    expect(wanted);
  }
  // Accepts "endloop", or "end loop" as some programs write it.
  void expectEnd(const char* wanted, const char* what) {
    if (word_.size() != 3 || !text::equalIgnoringCase(word_, "end")) return expect(wanted);
    nextWord(what);
    expect(what);
  }
  // Returns false at the end of the solid.
  bool nextIsFacet() {
    while (findWord()) {
      if (word_ == "facet" || text::equalIgnoringCase(word_, "facet")) return true;
      if (skipsColor()) continue;
      expectEnd("endsolid", "solid");
      return false;
    }
    warnings_.push_back("the file ends without 'endsolid': it may have been cut off");
    return false;
  }
  [[noreturn]] void throwUnexpected(const char* wanted) const {
    const std::string found =
        text::hasControl(word_) ? std::string("binary data") : text::quoted(word_);
    throw FileError(name_, lines_.number(), found + " where '" + wanted + "' should be");
  }

  void readFacet() {
    nextMustBe("normal");
    for (int k = 0; k < 3; ++k) nextWord("normal"); // recomputed from the corners when needed
    nextMustBe("outer");
    nextMustBe("loop");
    Triangle triangle;
    for (std::int32_t& corner : triangle) {
      nextMustBe("vertex");
      Vec3 p;
      for (int k = 0; k < 3; ++k) {
        nextWord("a coordinate");
        p[k] = text::number(word_, name_, lines_.number(), "a coordinate");
      }
      corner = weld_.index(p);
    }
    nextWord("endloop");
    expectEnd("endloop", "loop");
    nextWord("endfacet");
    expectEnd("endfacet", "facet");
    triangles_.push_back(triangle);
  }

  const std::string& name_;
  text::Lines lines_;
  std::string_view line_;
  text::Words words_{{}}; // remaining words of the line
  std::string_view word_;
  bool colored_ = false;
  VertexWeld weld_;
  std::vector<Triangle> triangles_;
  std::vector<std::string>& warnings_;
};

} // namespace

TriangleMesh parseStl(std::string_view bytes, const std::string& name,
                      std::vector<std::string>* warnings) {
  std::vector<std::string> unheard;
  if (!warnings) warnings = &unheard;
  if (bytes.empty()) throw FileError(name, 1, "the file is empty");
  switch (kindOf(bytes)) {
  case Kind::binary:
    return parseBinary(bytes, name, *warnings);
  case Kind::ascii:
    return AsciiParser(withoutByteOrderMark(bytes), name, *warnings).parse();
  case Kind::other_text:
    break;
  }
  throw FileError(name, 1, "not an STL file: a text that does not begin with 'solid'");
}

} // namespace patina
