// Splits text that arrives in pieces into lines.
#pragma once

#include <string>
#include <string_view>

namespace patina {

// The first line end decides whether lines end with LF, CR LF or CR.
class LineBuffer {
 public:
  // Appends the bytes that `read(char*, capacity)` returns and returns their number.
  template <class Read> std::size_t appendFrom(const Read& read, std::size_t capacity) {
    bytes_.erase(0, used_);
    used_ = 0;
    const std::size_t before = bytes_.size();
    bytes_.resize(before + capacity);
    const std::size_t count = read(bytes_.data() + before, capacity);
    bytes_.resize(before + count);
    return count;
  }
  void append(std::string_view bytes) {
    appendFrom([bytes](char* to, std::size_t) { return bytes.copy(to, bytes.size()); },
               bytes.size());
  }

  // Returns false if no complete line is left; `is_last` accepts the remaining text as a line. The
  // line is valid until the next append.
  bool next(std::string_view& line, bool is_last = false) {
    std::size_t end = bytes_.find(terminator_ ? terminator_ : '\n', searched_ + used_);
    if (!terminator_) {
      const std::size_t cr = bytes_.find('\r', used_);
      // The byte after a CR decides whether the CR alone ends the line.
      if (cr < end && cr + 1 == bytes_.size() && !is_last) return false;
      const bool alone = cr < end && cr + 1 < bytes_.size() && bytes_[cr + 1] != '\n';
      if (alone || (cr != std::string::npos && end == std::string::npos)) end = cr;
      if (end != std::string::npos) terminator_ = bytes_[end];
    }
    if (end == std::string::npos && !(is_last && used_ < bytes_.size())) {
      searched_ = terminator_ ? bytes_.size() - used_ : 0;
      return false;
    }
    searched_ = 0;
    line = std::string_view(bytes_).substr(used_, end - used_);
    if (terminator_ != '\r' && line.ends_with('\r')) line.remove_suffix(1);
    used_ = end == std::string::npos ? bytes_.size() : end + 1;
    return true;
  }

  std::size_t rest() const { return bytes_.size() - used_; } // bytes not returned as lines yet

 private:
  std::string bytes_;
  std::size_t used_ = 0, searched_ = 0; // searched_: bytes after used_ without a terminator
  char terminator_ = 0;                 // 0 until the first line has ended
};

} // namespace patina
