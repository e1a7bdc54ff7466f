#include "core/csv.h"

#include <algorithm>
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

constexpr std::size_t kChunk = 1 << 16;
constexpr std::size_t kLongestLine = 1 << 20;

CsvReader::Source sourceOf(const std::filesystem::path& path) {
  const std::string name = path.string();
  const auto file = std::make_shared<Descriptor>(openToRead(path));
  struct stat info {};
  if (::fstat(file->get(), &info) == 0 && S_ISDIR(info.st_mode))
    throw FileError(name, 0, "is a folder, not a file");
  return [file, name](char* buffer, std::size_t capacity) {
    return readSome(file->get(), name, buffer, capacity);
  };
}

// Passes UTF-8 bytes on and converts UTF-16, which starts with a byte order mark.
CsvReader::Source utf8Of(CsvReader::Source source) {
  enum class Encoding { unknown, bytes, little, big };
  return [source = std::move(source), raw = std::string(),
          encoding = Encoding::unknown](char* buffer, std::size_t capacity) mutable {
    if (encoding == Encoding::bytes) return source(buffer, capacity);
    const auto append = [&](std::size_t most) {
      const std::size_t before = raw.size();
      raw.resize(before + most);
      const std::size_t count = source(raw.data() + before, most);
      raw.resize(before + count);
      return count > 0;
    };
    if (encoding == Encoding::unknown) {
      while (raw.size() < 2 && append(2 - raw.size())) {
      }
      encoding = raw == "\xFF\xFE"   ? Encoding::little
                 : raw == "\xFE\xFF" ? Encoding::big
                                     : Encoding::bytes;
      if (encoding == Encoding::bytes) return raw.copy(buffer, capacity);
      raw.clear();
    }
    std::size_t count = 0;
    while (count == 0 && append(capacity / 3)) { // a code unit becomes at most three bytes
      const std::size_t low = encoding == Encoding::little ? 0 : 1;
      std::size_t at = 0;
      for (; at + 1 < raw.size(); at += 2) {
        const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(raw[at + i]); };
        count += putUtf8(static_cast<char16_t>(byte(low) | byte(1 - low) << 8), buffer + count);
      }
      raw.erase(0, at);
    }
    return count;
  };
}

CsvTable wholeOf(CsvReader reader) {
  CsvTable table;
  table.columns = reader.columns();
  for (std::vector<double> row; reader.next(row);) table.rows.push_back(row);
  return table;
}

} // namespace

CsvReader::CsvReader(const std::filesystem::path& path, const CsvColumns& columns)
    : CsvReader(sourceOf(path), path.string(), columns) {
  std::error_code unknown;
  const auto size = std::filesystem::file_size(path, unknown);
  if (!unknown) size_ = static_cast<double>(size);
}

CsvReader::CsvReader(Source source, std::string name, const CsvColumns& columns)
    : source_(utf8Of(std::move(source))), name_(std::move(name)), parser_(name_, columns) {
  std::string_view line;
  std::vector<double> none;
  while (!parser_.hasHeader()) {
    if (!nextLine(line)) throw FileError(name_, 0, parser_.emptyText());
    parser_.take(line, none);
  }
}

bool CsvReader::nextLine(std::string_view& line) {
  while (!lines_.next(line, ended_)) {
    if (ended_) return false;
    if (lines_.rest() > kLongestLine)
      throw FileError(name_, parser_.line() + 1, "is a line of more than 1 MB");
    const std::size_t count = lines_.appendFrom(source_, kChunk);
    bytes_ += static_cast<double>(count);
    ended_ = count == 0;
  }
  return true;
}

bool CsvReader::next(std::vector<double>& row) {
  for (std::string_view line; nextLine(line);)
    if (parser_.take(line, row)) return true;
  return false;
}

double CsvReader::fraction() const {
  return size_ > 0 ? std::min(bytes_ / size_, 1.0) : 0;
}

CsvReader::Source sourceOfText(std::string_view text) {
  return [text](char* buffer, std::size_t capacity) mutable {
    const std::size_t count = text.copy(buffer, capacity);
    text.remove_prefix(count);
    return count;
  };
}

CsvTable parseCsv(const std::string& text, const std::string& name,
                  const std::vector<std::string>& required) {
  return wholeOf(CsvReader(sourceOfText(text), name, {required, {}, {}, true}));
}

CsvTable readCsv(const std::filesystem::path& path, const std::vector<std::string>& required) {
  return wholeOf(CsvReader(path, {required, {}, {}, true}));
}

std::string csvHeader(const std::vector<std::string>& columns) {
  std::string text;
  for (const std::string& column : columns) text.append(text.empty() ? "" : ",").append(column);
  return text += '\n';
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
