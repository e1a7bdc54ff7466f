// Any bytes give whole records and their end; records are written and read back unchanged.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "workspace/journal.h"
#include "workspace/journal_lines.h"

namespace {

void check(std::string_view text) {
  const patina::JournalText journal = patina::parseJournal(text);
  std::string written = patina::journalHeader(journal.from);
  for (std::size_t i = 0; i < journal.events.size(); ++i)
    written += patina::journalLine(i + 1, journal.events[i], i + 1 < journal.events.size());
  const patina::JournalText again = patina::parseJournal(written);
  if (again.torn || again.damaged_line != 0 || again.events != journal.events) std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  check(text);
  // Random bytes never match a checksum: here every line is a record with a valid one.
  std::string records;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end != 0) records += patina::withChecksum(std::string(text.substr(0, end)));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  check(records);
  return 0;
}
