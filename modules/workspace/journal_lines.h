// Lines of a journal without what they mean: numbers and checksums. Internal to the workspace.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace patina {

// {"n":7,"stroke":{...},"check":"0123456789abcdef"}: the check is over all that stands before it.
inline constexpr std::string_view kCheckKey = ",\"check\":\"";
inline constexpr std::size_t kCheckDigits = 16;

std::string sealed(std::string record); // "{...}" to a line with its check and '\n'

struct JournalRecord {
  std::uint64_t number = 0; // 0 = the heading
  std::string_view text;    // the whole line without '\n', JSON
  std::string_view check;
  std::size_t end = 0; // offset of what follows the line
};

struct JournalLines {
  std::vector<JournalRecord> records; // the heading, if any, first; numbers ascend without a gap
  bool torn = false;
  std::size_t damaged_line = 0;
  std::string damage;
};
// Views into `text`.
JournalLines journalLines(std::string_view text);

} // namespace patina
