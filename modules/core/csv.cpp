#include "core/csv_rows.h"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <memory>
#include <string_view>
#include <sys/stat.h>

#include "core/descriptor.h"
#include "core/error.h"
#include "core/numbers.h"
#include "core/utf8.h"

namespace patina {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
    text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  for (;;) {
    const std::size_t at = line.find(separator);
    cells.push_back(trimmed(line.substr(0, at)));
    if (at == std::string_view::npos) return cells;
    line.remove_prefix(at + 1);
  }
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

// A message must stay one readable line whatever the file holds.
std::string quoted(std::string_view cell) {
  std::string text = "'";
  for (const char c : cell.substr(0, 40))
    text += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return text + (cell.size() > 40 ? "...'" : "'");
}

// "1,5;2,5", or plain "1,5,2,5,3,5" where 3 numbers were due: both come from a decimal comma.
bool looksLikeDecimalComma(std::string_view line, std::size_t found, std::size_t due) {
  if (line.find(';') != std::string_view::npos) return true;
  return found == 2 * due;
}

constexpr const char* kDecimalComma =
    "decimal commas: write numbers with a point and separate them with commas";

constexpr std::size_t kChunk = 1 << 16;
constexpr std::size_t kLongestLine = 1 << 20;

CsvReader::Source sourceOf(const std::filesystem::path& path) {
  const std::string name = path.string();
  const auto file = std::make_shared<Descriptor>(openToRead(path));
  struct stat info {};
  if (::fstat(file->get(), &info) == 0 && S_ISDIR(info.st_mode))
    throw FileError(name, 0, "is a folder, not a file");
  return [file, name](char* buffer, std::size_t room) {
    return readSome(file->get(), name, buffer, room);
  };
}

CsvTable wholeOf(CsvReader reader) {
  CsvTable table;
  table.columns = reader.columns();
  for (std::vector<double> row; reader.next(row);) table.rows.push_back(row);
  return table;
}

} // namespace

void parseCsvRow(std::string_view line, std::size_t due, const std::string& name,
                 std::size_t number, std::vector<double>& row) {
  const std::vector<std::string_view> cells = split(line, ',');
  if (cells.size() != due) {
    if (looksLikeDecimalComma(line, cells.size(), due))
      throw FileError(name, number, kDecimalComma);
    // A whole number among them, "0,5,1,2,5", hides that the others were broken in two.
    const bool broken = cells.size() > due && line.find('.') == std::string_view::npos;
    throw FileError(name, number,
                    std::to_string(cells.size()) + " values where the header names " +
                        std::to_string(due) +
                        (broken ? ", none with a point: are there decimal commas?" : ""));
  }
  row.clear();
  for (const std::string_view cell : cells) {
    const std::optional<double> value = parseNumber(cell);
    if (!value) {
      if (cell.find(';') != std::string_view::npos) throw FileError(name, number, kDecimalComma);
      throw FileError(name, number, quoted(cell) + " is not a number");
    }
    row.push_back(*value);
  }
}

CsvReader::CsvReader(const std::filesystem::path& path, const std::vector<std::string>& expected)
    : CsvReader(sourceOf(path), path.string(), expected) {
  std::error_code unknown;
  const auto size = std::filesystem::file_size(path, unknown);
  if (!unknown) size_ = static_cast<double>(size);
}

CsvReader::CsvReader(Source source, std::string name, const std::vector<std::string>& expected)
    : source_(std::move(source)), name_(std::move(name)) {
  std::string_view line;
  if (!nextLine(line))
    throw FileError(name_, 0, "is empty: its first line must be '" + joined(expected) + "'");
  line = withoutByteOrderMark(line);
  for (const std::string_view cell : split(line, ',')) columns_.emplace_back(cell);
  const bool right = columns_.size() >= expected.size() &&
                     std::equal(expected.begin(), expected.end(), columns_.begin());
  if (!right)
    throw FileError(
        name_, 1, "header is " + quoted(line) + ", it must begin with '" + joined(expected) + "'");
}

bool CsvReader::nextLine(std::string_view& line) {
  std::size_t searched = used_;
  std::size_t end;
  while ((end = buffer_.find('\n', searched)) == std::string::npos && !ended_) {
    buffer_.erase(0, used_);
    used_ = 0;
    searched = buffer_.size();
    if (searched > kLongestLine) throw FileError(name_, line_ + 1, "is a line of more than 1 MB");
    buffer_.resize(searched + kChunk);
    const std::size_t got = source_(buffer_.data() + searched, kChunk);
    buffer_.resize(searched + got);
    bytes_ += static_cast<double>(got);
    ended_ = got == 0;
  }
  if (used_ == buffer_.size()) return false;
  end = std::min(end, buffer_.size());
  line = trimmed(std::string_view(buffer_).substr(used_, end - used_));
  used_ = std::min(end + 1, buffer_.size());
  ++line_;
  return true;
}

bool CsvReader::next(std::vector<double>& row) {
  std::string_view line;
  do {
    if (!nextLine(line)) return false;
  } while (line.empty());
  parseCsvRow(line, columns_.size(), name_, line_, row);
  return true;
}

double CsvReader::fraction() const {
  return size_ > 0 ? std::min(bytes_ / size_, 1.0) : 0;
}

CsvReader::Source sourceOfText(std::string_view text) {
  return [text](char* buffer, std::size_t room) mutable {
    const std::size_t count = text.copy(buffer, room);
    text.remove_prefix(count);
    return count;
  };
}

CsvTable parseCsv(const std::string& text, const std::string& name,
                  const std::vector<std::string>& expected) {
  return wholeOf(CsvReader(sourceOfText(text), name, expected));
}

CsvTable readCsv(const std::filesystem::path& path, const std::vector<std::string>& expected) {
  return wholeOf(CsvReader(path, expected));
}

std::string csvHeader(const std::vector<std::string>& columns) {
  return joined(columns) + "\n";
}

std::string csvRow(const std::vector<double>& row) {
  std::string text;
  for (std::size_t i = 0; i < row.size(); ++i)
    text.append(i > 0 ? "," : "").append(formatNumber(row[i]));
  return text += '\n';
}

CsvWriter::CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns)
    : file_(path), text_(csvHeader(columns)) {}

void CsvWriter::add(const std::vector<double>& row) {
  text_ += csvRow(row);
  if (text_.size() < kChunk) return;
  file_.append(text_);
  text_.clear();
}

void CsvWriter::commit() {
  file_.append(text_);
  file_.commit();
}

void writeCsv(const std::filesystem::path& path, const CsvTable& table) {
  CsvWriter writer(path, table.columns);
  for (const std::vector<double>& row : table.rows) writer.add(row);
  writer.commit();
}

} // namespace patina
