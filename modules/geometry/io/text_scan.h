// Words, lines and safe quoting for the text mesh formats. Internal to the readers.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/numbers.h"
#include "core/utf8.h"

namespace patina::text {

inline bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

inline bool isControl(char c) {
  const auto u = static_cast<unsigned char>(c);
  return (u < 0x20 && !isBlank(c) && c != '\n') || u == 0x7f;
}
inline bool hasControl(std::string_view s) {
  return std::any_of(s.begin(), s.end(), isControl);
}

bool equalIgnoringCase(std::string_view a, std::string_view b);

// Makes a word printable in a message.
inline std::string shown(std::string_view word) {
  std::string out;
  for (const char c : word)
    out += static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f ? '?' : c;
  return out;
}
inline std::string quoted(std::string_view word, std::size_t most = 32) {
  return "'" + shown(word.substr(0, most)) + (word.size() > most ? "...'" : "'");
}

// Returns the cause for a file that has vertices but no face.
std::string pointCloud(std::size_t points, const char* why);
// Returns the warning for colours of "vertices", "faces" or others named by `whose`.
inline std::string colorsLeftOut(const std::string& whose) {
  return "the colours of its " + whose + " are left out";
}
inline constexpr const char* kOpaque = "its colours are shown opaque: transparency is left out";

// Returns '\r' for text of old Macs, which contains no '\n'.
inline char lineEndOf(std::string_view bytes) {
  return bytes.find('\n') == bytes.npos && bytes.find('\r') != bytes.npos ? '\r' : '\n';
}

// Iterates over the physical lines, without their ends.
class Lines {
 public:
  explicit Lines(std::string_view bytes) : Lines(bytes, lineEndOf(bytes)) {}
  Lines(std::string_view bytes, char line_end) : rest_(bytes), line_end_(line_end) {}
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const void* found = std::memchr(rest_.data(), line_end_, rest_.size());
    const std::size_t length =
        found ? static_cast<std::size_t>(static_cast<const char*>(found) - rest_.data())
              : rest_.size();
    line = rest_.substr(0, length);
    rest_.remove_prefix(std::min(length + 1, rest_.size()));
    ++number_;
    return true;
  }
  std::size_t number() const { return number_; } // number of the line last returned
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  char line_end_;
  std::size_t number_ = 0;
};

// Iterates over the words between blanks of one line; an empty word marks the end.
class Words {
 public:
  explicit Words(std::string_view line) : at_(line.data()), end_(line.data() + line.size()) {}
  std::string_view next() {
    while (at_ != end_ && isBlank(*at_)) ++at_;
    const char* first = at_;
    while (at_ != end_ && !isBlank(*at_)) ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
  }

 private:
  const char* at_;
  const char* end_;
};

// Parses as std::from_chars does, in half the time.
inline std::from_chars_result wholeNumber(const char* at, const char* end, std::int64_t& value) {
  constexpr std::ptrdiff_t kMaxDigits = 17; // Numbers with so many digits always fit.
  const char* const first = at + (at != end && *at == '-');
  const char* digit = first;
  std::int64_t sum = 0;
  for (; digit != end && *digit >= '0' && *digit <= '9' && digit - first < kMaxDigits; ++digit)
    sum = 10 * sum + (*digit - '0');
  if (digit == first || digit - first == kMaxDigits) return std::from_chars(at, end, value);
  value = first == at ? sum : -sum;
  return {digit, std::errc()};
}

[[noreturn]] void throwNotANumber(std::string_view word, const std::string& name, std::size_t line,
                                  const char* what);

// Parses a number; `what` names it in the error ("a coordinate").
inline double number(std::string_view word, const std::string& name, std::size_t line,
                     const char* what) {
  if (const auto value = parseNumber(word)) return *value;
  throwNotANumber(word, name, line, what);
}

} // namespace patina::text
