#include "geometry/io/commented_file.h"

#include <algorithm>
#include <string_view>
#include <system_error>

#include "core/descriptor.h"
#include "core/file.h"

namespace patina {

namespace fs = std::filesystem;

std::string readCommented(const fs::path& path) {
  constexpr std::size_t kLongestComment = 4096;
  std::error_code none;
  if (!fs::is_regular_file(path, none)) return readFile(path);
  const Descriptor file(openToRead(path));
  std::string text, part(65536, '\0');
  text.reserve(fs::file_size(path, none));
  std::size_t room = 0; // what the comment may still take
  bool in_comment = false;
  while (const std::size_t got = readSome(file.get(), path.string(), part.data(), part.size()))
    for (std::string_view left(part.data(), got); !left.empty();) {
      std::size_t end = left.find(in_comment ? '\n' : '#');
      if (in_comment) end = std::min(end, left.substr(0, end).find('\r'));
      const std::string_view words = left.substr(0, end);
      text.append(in_comment ? words.substr(0, room) : words);
      if (in_comment) room -= std::min(room, words.size());
      left.remove_prefix(words.size());
      if (left.empty()) continue;
      in_comment = !in_comment;
      if (!in_comment) continue;
      const std::size_t before = text.find_last_not_of(" \t");
      const bool has_line = before == text.npos || text[before] == '\n' || text[before] == '\r';
      room = has_line ? 1 : kLongestComment;
    }
  return text;
}

} // namespace patina
