// The body of a PLY file as a stream of numbers, ascii or binary alike. Internal to the reader.
//
// Both sources offer the same four calls: beginItem, value, length, endItem; and end for the file.
#pragma once

#include <bit>
#include <cstring>

#include "geometry/io/ply_header.h"
#include "geometry/io/text_scan.h"

namespace patina {

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
    // A word takes a byte and a blank, so no line can hold a list longer than this.
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
    // Some programs end the file with a newline or padding; data means that a count was wrong.
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
      std::memcpy(&bits, from, sizeof bits); // the processors we build for are little-endian
    at_ += sizeof(Bits);
    return std::bit_cast<T>(bits);
  }

  const std::string& name_;
  std::string_view body_;
  std::size_t body_byte_;
  std::size_t at_ = 0;
};

} // namespace patina
