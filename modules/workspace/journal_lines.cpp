#include "workspace/journal_lines.h"

#include <charconv>

#include "core/sha256.h"

namespace patina {
namespace {

constexpr std::string_view kNumberKey = "{\"n\":";
constexpr std::string_view kMoreKey = ",\"more\":true";
constexpr std::string_view kClose = "\"}";

std::string checksumOf(std::string_view record) {
  return sha256(record).substr(0, kChecksumDigits);
}

// Returns the cause of damage, "" for a valid line.
std::string readLine(std::string_view line, JournalRecord& record) {
  const std::size_t tail = kChecksumKey.size() + kChecksumDigits + kClose.size();
  if (!line.starts_with(kNumberKey) || line.size() < kNumberKey.size() + tail)
    return "is not a journal record";
  const std::string_view body = line.substr(0, line.size() - tail);
  if (line.substr(body.size(), kChecksumKey.size()) != kChecksumKey || !line.ends_with(kClose))
    return "the record has no checksum";
  record.checksum = line.substr(body.size() + kChecksumKey.size(), kChecksumDigits);
  if (record.checksum != checksumOf(body)) return "the record's checksum differs: it was changed";
  const std::string_view digits = body.substr(kNumberKey.size());
  const auto [stop, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), record.number);
  if (error != std::errc()) return "the record has no number";
  record.more = body.substr(static_cast<std::size_t>(stop - body.data())).starts_with(kMoreKey);
  record.text = line;
  return "";
}

} // namespace

std::string withChecksum(std::string record) {
  record.pop_back();
  const std::string checksum = checksumOf(record);
  record.append(kChecksumKey).append(checksum).append(kClose);
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
    std::string cause = end == std::string_view::npos ? "the record has no line end" : "";
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
      // Each record is on disk before the next begins, so only the last can be incomplete. After a
      // power loss its end may be present while its middle is zeros.
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
  while (!lines.records.empty() && lines.records.back().more) {
    lines.records.pop_back();
    lines.torn = lines.damaged_line == 0;
  }
  return lines;
}

} // namespace patina
