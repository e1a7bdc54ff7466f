#include "workspace/journal_lines.h"

#include <charconv>

#include "core/sha256.h"

namespace patina {
namespace {

constexpr std::string_view kNumberKey = "{\"n\":";
constexpr std::string_view kClose = "\"}";

std::string checkOf(std::string_view record) {
  return sha256(record).substr(0, kCheckDigits);
}

// An empty cause where the line is whole.
std::string readLine(std::string_view line, JournalRecord& record) {
  const std::size_t tail = kCheckKey.size() + kCheckDigits + kClose.size();
  if (!line.starts_with(kNumberKey) || line.size() < kNumberKey.size() + tail)
    return "is no record of a journal";
  const std::string_view body = line.substr(0, line.size() - tail);
  if (line.substr(body.size(), kCheckKey.size()) != kCheckKey || !line.ends_with(kClose))
    return "the record has no checksum";
  record.check = line.substr(body.size() + kCheckKey.size(), kCheckDigits);
  if (record.check != checkOf(body)) return "the record's checksum differs: it was changed";
  const std::string_view digits = body.substr(kNumberKey.size());
  const auto [stop, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), record.number);
  if (error != std::errc()) return "the record has no number";
  record.text = line;
  return "";
}

} // namespace

std::string sealed(std::string record) {
  record.pop_back();
  const std::string check = checkOf(record);
  record.append(kCheckKey).append(check).append(kClose);
  record += '\n';
  return record;
}

JournalLines journalLines(std::string_view text) {
  JournalLines lines;
  std::size_t at = 0;
  for (std::size_t number = 1; at < text.size(); ++number) {
    const std::size_t end = text.find('\n', at);
    const std::string_view line = text.substr(at, end == std::string_view::npos ? end : end - at);
    JournalRecord record;
    std::string cause = end == std::string_view::npos ? "the record does not end" : "";
    if (cause.empty()) cause = readLine(line, record);
    if (cause.empty()) {
      const bool first = lines.records.empty();
      const std::uint64_t wanted = first ? 1 : lines.records.back().number + 1;
      if (record.number != wanted && !(first && record.number == 0)) {
        cause = "record " + std::to_string(record.number) + " stands where record " +
                std::to_string(wanted) + " should";
      }
    }
    if (!cause.empty()) {
      // Each record is on disk before the next begins, so only the last can be half written; after
      // a loss of power its end may be there and its middle be zeros.
      const bool last = end == std::string_view::npos || end + 1 == text.size();
      lines.torn =
          end == std::string_view::npos || (last && line.find('\0') != std::string_view::npos);
      if (!lines.torn) {
        lines.damaged_line = number;
        lines.damage = cause;
      }
      break;
    }
    at = end + 1;
    record.end = at;
    lines.records.push_back(record);
  }
  return lines;
}

} // namespace patina
