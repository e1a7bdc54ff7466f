// Whatever the bytes: whole records and where they end; what was read is written and read the same.
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
  std::string written = patina::journalHeading(journal.from);
  for (std::size_t i = 0; i < journal.events.size(); ++i)
    written += patina::journalLine(i + 1, journal.events[i]);
  const patina::JournalText again = patina::parseJournal(written);
  if (again.torn || again.damaged_line != 0 || again.events != journal.events) std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  check(text);
  // With checksums, which no chance finds: every line of the bytes as a record.
  std::string records;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end != 0) records += patina::sealed(std::string(text.substr(0, end)));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  check(records);
  return 0;
}
