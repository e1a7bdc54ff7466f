#include "core/csv.h"

#include <string_view>

#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"

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

std::vector<double> parseRow(std::string_view line, std::size_t due, const std::string& name,
                             std::size_t number) {
  const std::vector<std::string_view> cells = split(line, ',');
  if (cells.size() != due) {
    if (looksLikeDecimalComma(line, cells.size(), due))
      throw FileError(name, number, kDecimalComma);
    throw FileError(name, number,
                    std::to_string(cells.size()) + " values where the header names " +
                        std::to_string(due));
  }
  std::vector<double> row;
  row.reserve(due);
  for (const std::string_view cell : cells) {
    const std::optional<double> value = parseNumber(cell);
    if (!value) {
      if (cell.find(';') != std::string_view::npos) throw FileError(name, number, kDecimalComma);
      throw FileError(name, number, quoted(cell) + " is not a number");
    }
    row.push_back(*value);
  }
  return row;
}

} // namespace

CsvTable parseCsv(const std::string& text, const std::string& name,
                  const std::vector<std::string>& expected) {
  CsvTable table;
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3); // a spreadsheet's byte order mark
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (number > 1) {
      if (!line.empty()) table.rows.push_back(parseRow(line, table.columns.size(), name, number));
      continue;
    }
    for (const std::string_view cell : split(line, ',')) table.columns.emplace_back(cell);
    bool right = table.columns.size() >= expected.size();
    for (std::size_t i = 0; right && i < expected.size(); ++i)
      right = table.columns[i] == expected[i];
    if (!right) {
      throw FileError(
          name, 1, "header is " + quoted(line) + ", it must begin with '" + joined(expected) + "'");
    }
  }
  if (table.columns.empty()) {
    throw FileError(name, 0, "is empty: its first line must be '" + joined(expected) + "'");
  }
  return table;
}

CsvTable readCsv(const std::filesystem::path& path, const std::vector<std::string>& expected) {
  return parseCsv(readFile(path), path.string(), expected);
}

void writeCsv(const std::filesystem::path& path, const CsvTable& table) {
  std::string text = joined(table.columns) + "\n";
  for (const std::vector<double>& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += ',';
      text += formatNumber(row[i]);
    }
    text += '\n';
  }
  writeFileAtomically(path, text);
}

} // namespace patina
