// Numbers and checksums of a journal's lines, without their content. Internal to the workspace.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace patina {

// {"n":7,"stroke":{...},"check":"0123456789abcdef"}: the checksum covers all text before it.
inline constexpr std::string_view kChecksumKey = ",\"check\":\"";
inline constexpr std::size_t kChecksumDigits = 16;

std::string withChecksum(std::string record); // "{...}" to a line with its checksum and '\n'

struct JournalRecord {
  std::uint64_t number = 0; // 0 = the header
  bool more = false;        // the command's edits are complete only with the next record
  std::string_view text;    // the whole line without '\n', JSON
  std::string_view checksum;
  std::size_t end = 0; // offset of the next line
};

struct JournalLines {
  // The header first, if any; numbers are consecutive, and no command is incomplete.
  std::vector<JournalRecord> records;
  bool torn = false;
  std::size_t damaged_line = 0;
  std::string damage;
};
// The result holds views into `text`.
JournalLines journalLines(std::string_view text);

} // namespace patina
