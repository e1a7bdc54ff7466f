// Words, lines and safe quoting for the text mesh formats. Internal to the readers.
#pragma once

#include <algorithm>
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

// Fit for one line of a message, whatever the bytes are.
inline std::string quoted(std::string_view word) {
  constexpr std::size_t kShown = 32;
  std::string out = "'";
  for (const char c : word.substr(0, kShown))
    out += static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f ? '?' : c;
  return out + (word.size() > kShown ? "...'" : "'");
}

// Physical lines, without their ends.
class Lines {
 public:
  explicit Lines(std::string_view bytes) : rest_(bytes) {}
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const void* found = std::memchr(rest_.data(), '\n', rest_.size());
    const std::size_t length =
        found ? static_cast<std::size_t>(static_cast<const char*>(found) - rest_.data())
              : rest_.size();
    line = rest_.substr(0, length);
    rest_.remove_prefix(std::min(length + 1, rest_.size()));
    ++number_;
    return true;
  }
  std::size_t number() const { return number_; } // of the line last returned
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

// Words between blanks within one line; an empty word is the end.
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

[[noreturn]] void throwNotANumber(std::string_view word, const std::string& name, std::size_t line,
                                  const char* what);

// `what` names the thing that should stand there ("a coordinate").
inline double number(std::string_view word, const std::string& name, std::size_t line,
                     const char* what) {
  if (const auto value = parseNumber(word)) return *value;
  throwNotANumber(word, name, line, what);
}

} // namespace patina::text
