#include "core/csv_parser.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "core/numbers.h"
#include "core/units.h"
#include "core/utf8.h"

namespace patina {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) + 1 - first);
}

// Splits at separators outside quotes and removes the quotes, which open at a cell's start only.
// Returns none if a quoted cell does not end in the line.
std::vector<std::string> cellsOf(std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (line[i] == '"' && (quoted || trimmed(cells.back()).empty())) {
      quoted = !quoted;
    } else if (line[i] == separator && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += line[i];
    }
  }
  if (quoted) return {};
  for (std::string& cell : cells) cell = trimmed(cell);
  return cells;
}

std::string joined(const std::vector<std::string>& names, const char* between) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : between) + name;
  return text;
}

// Replaces control characters, so that a message stays one readable line.
std::string printableText(std::string_view text, std::size_t length = 40) {
  std::string out;
  for (const char c : text.substr(0, length))
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return out + (text.size() > length ? "..." : "");
}

std::string inQuotes(std::string_view text) {
  return "'" + printableText(text) + "'";
}

const char* nameOfSeparator(char separator) {
  return separator == ';' ? "semicolons" : separator == '\t' ? "tabs" : "commas";
}

std::string lowerCase(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

struct Heading {
  std::string name;                // lower case
  std::optional<std::string> unit; // absent without brackets
};

// "T (ms)" has the name "t" and the unit "ms".
Heading headingIn(std::string_view text) {
  Heading heading;
  const std::size_t open = text.find_last_of("[(");
  if (open != std::string_view::npos && open > 0 &&
      text.back() == (text[open] == '[' ? ']' : ')')) {
    heading.unit = trimmed(text.substr(open + 1, text.size() - open - 2));
    text = trimmed(text.substr(0, open));
  }
  heading.name = lowerCase(text);
  return heading;
}

// Returns true for an empty cell and the words that other programs write in place of a number.
bool isMissing(std::string_view text) {
  constexpr std::array<std::string_view, 11> kWords = {
      "", "na", "n/a", "null", "#n/a", "#null!", "#num!", "#div/0!", "#value!", "#ref!", "#name?"};
  return text.size() < 8 &&
         std::find(kWords.begin(), kWords.end(), lowerCase(text)) != kWords.end();
}

// Reads other spellings of NaN and infinity: missing values, and 1.#IND, -1.#QNAN, 1.#INF of
// Microsoft's C library.
std::optional<double> foreignNumber(std::string_view text) {
  if (isMissing(text)) return std::numeric_limits<double>::quiet_NaN();
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  if (!text.starts_with("1.#")) return std::nullopt;
  const bool infinite = text.starts_with("1.#INF") || text.starts_with("1.#J");
  const double value =
      infinite ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  return negative ? -value : value;
}

constexpr const char* kOpenQuote =
    "a quoted cell does not end in this line: remove the line break or the quote";
constexpr const char* kDecimalComma = "decimal commas need semicolons or tabs between the columns";

} // namespace

CsvParser::CsvParser(std::string name, CsvColumns columns)
    : name_(std::move(name)), wanted_(std::move(columns)), columns_(wanted_.required) {
  columns_.insert(columns_.end(), wanted_.optional.begin(), wanted_.optional.end());
  found_.assign(columns_.size(), false);
}

void CsvParser::assumeHeader(std::string_view line) {
  separator_ = ',';
  const std::size_t cells = 1 + static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
  const bool all = cells == found_.size();
  for (std::size_t i = 0; i < (all ? found_.size() : wanted_.required.size()); ++i) {
    cells_.push_back({columns_[i], static_cast<int>(i)});
    found_[i] = true;
  }
  has_header_ = true;
}

void CsvParser::refuse(const std::string& cause) const {
  throw FileError(name_, line_, cause);
}

bool CsvParser::has(const std::string& column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  const auto i = static_cast<std::size_t>(found - columns_.begin());
  return i >= found_.size() ? found != columns_.end() : found_[i];
}

bool CsvParser::take(std::string_view line, std::vector<double>& row) {
  ++line_;
  if (line_ == 1) line = withoutByteOrderMark(line);
  if (!has_header_) {
    has_header_ = readHeader(trimmed(line));
    return false;
  }
  const bool blank = std::all_of(line.begin(), line.end(), [this](char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == separator_;
  });
  if (blank || isComment(line)) return false;
  row.assign(columns_.size(), std::numeric_limits<double>::quiet_NaN());
  if (std::memchr(line.data(), '"', line.size()) != nullptr)
    readQuotedRow(line, row);
  else
    readRow(line, row);
  return true;
}

// A number begins with neither # nor %, but the text of a first column that nobody reads may: "#8"
// is such a text where there are more cells, and "# 8" where there are as many as columns.
bool CsvParser::isComment(std::string_view line) const {
  const std::string_view text = trimmed(line);
  if (!text.starts_with('#') && !text.starts_with('%')) return false;
  if (cells_.front().target >= 0) return !isMissing(trimmed(text.substr(0, text.find(separator_))));
  const bool is_word = text.size() > 1 && text[1] != ' ' && text[1] != '\t' && text[1] != text[0];
  const bool has_cells = text.find(separator_) != text.npos;
  return is_word ? !has_cells : cellsOf(line, separator_).size() != cells_.size();
}

// Sets the target of the cell that holds the wanted column: the one with the same name and unit,
// else the only one with a unit of the same dimension. Returns false if there is none; `cause` then
// explains why a cell of that name does not fit.
bool CsvParser::findColumn(std::size_t wanted, std::vector<Cell>& cells, std::string& cause) const {
  const std::string& name = columns_[wanted];
  const Heading heading = headingIn(name);
  const std::optional<Unit> unit = parseUnit(heading.unit.value_or(""));
  Cell* found = nullptr;
  bool ambiguous = false;
  for (Cell& cell : cells) {
    const Heading own = headingIn(cell.name);
    if (own.name != heading.name || cell.target >= 0) continue;
    const bool same = cell.name == name;
    const std::optional<Unit> own_unit = parseUnit(own.unit.value_or(""));
    const std::string column = "column " + inQuotes(cell.name);
    if (same) {
      if (found && found->name == name) {
        cause = "the column " + inQuotes(name) + " stands twice";
        return false;
      }
      found = &cell;
      found->multiplier = found->divisor = 1;
    } else if (heading.unit && !own.unit) {
      cause = column + " has no unit: write '" + name + "' or another unit";
    } else if (!unit || !own_unit || own_unit->exponents != unit->exponents) {
      const std::string known = unit ? unitsLike(*unit) : "";
      cause = column + " is not in a known unit: write '" + name + "'" +
              (known.empty() ? "" : " or one of " + known);
    } else if (!found) {
      found = &cell;
      found->multiplier = own_unit->multiplier;
      found->divisor = own_unit->divisor;
    } else if (found->name != name) {
      ambiguous = true;
      cause = inQuotes(found->name) + " and " + inQuotes(cell.name) + " are the same column";
    }
  }
  if (!found || (ambiguous && found->name != name)) return false;
  cause.clear();
  found->target = static_cast<int>(wanted);
  return true;
}

// Returns false if the line precedes the header.
bool CsvParser::readHeader(std::string_view line) {
  if (line.empty()) return false;
  if (line.starts_with("sep=") && line.size() <= 5) { // spreadsheets write this line
    separator_ = line.size() == 5 ? line[4] : '\t';
    if (separator_ != ';' && separator_ != '\t' && separator_ != ',')
      refuse(inQuotes(line) + " is no known separator: write a semicolon, a tab or a comma");
    return false;
  }
  const bool comment = line.front() == '#' || line.front() == '%';
  const std::string_view text = comment ? trimmed(line.substr(1)) : line;
  char separator = separator_;
  for (const char candidate : {';', '\t', ','})
    if (!separator && cellsOf(text, candidate).size() > 1) separator = candidate;
  if (!separator) separator = ',';
  std::vector<Cell> cells;
  for (const std::string& name : cellsOf(text, separator))
    cells.push_back({name.empty() ? "(no name)" : name});
  if (cells.empty() && comment) return false;
  if (cells.empty()) refuse(kOpenQuote);
  const auto fail = [&](const std::string& cause) {
    refuse("header is " + inQuotes(line) + ", separated by " + nameOfSeparator(separator) + ": " +
           cause);
  };
  for (std::size_t i = 0; i < found_.size(); ++i) {
    const bool required = i < wanted_.required.size();
    std::string cause;
    const bool found = findColumn(i, cells, cause);
    if (!found && comment && required) return false;
    if (!cause.empty()) fail(cause);
    if (!found && required)
      fail("it lacks " + inQuotes(columns_[i]) + " of '" + joined(wanted_.required, ",") + "'" +
           (cells.size() < 2 ? ", or a comma, semicolon or tab between columns" : ""));
    found_[i] = found;
  }
  separator_ = separator;
  for (Cell& cell : cells)
    if (wanted_.others && cell.target < 0) {
      cell.target = static_cast<int>(columns_.size());
      columns_.push_back(cell.name);
    }
  cells_ = std::move(cells);
  return true;
}

std::string CsvParser::emptyText() const {
  return "is empty: its first line must be '" + joined(wanted_.required, ",") +
         "', in any order and in any units";
}

std::string CsvParser::leftOut() const {
  std::vector<std::string> names;
  for (const Cell& cell : cells_) {
    const auto isCell = [&](const std::string& name) {
      return headingIn(name).name == headingIn(cell.name).name;
    };
    if (cell.target < 0 && std::none_of(wanted_.unread.begin(), wanted_.unread.end(), isCell))
      names.push_back(printableText(cell.name));
  }
  if (names.empty()) return "";
  constexpr std::size_t kNamed = 8;
  const std::size_t more = names.size() > kNamed ? names.size() - kNamed : 0;
  names.resize(names.size() - more);
  return name_ + (names.size() + more > 1 ? ": columns" : ": column") +
         " left out: " + joined(names, ", ") +
         (more > 0 ? " and " + std::to_string(more) + " more" : "");
}

void CsvParser::refuseCount(std::string_view line, std::size_t count) const {
  const bool has_semicolon = line.find(';') != std::string_view::npos;
  if (separator_ == ',' && (has_semicolon || count == 2 * cells_.size())) refuse(kDecimalComma);
  // Whole numbers in the row ("0,5,1,2,5") keep the count from being exactly twice the columns.
  const bool broken =
      separator_ == ',' && count > cells_.size() && line.find('.') == std::string_view::npos;
  refuse(std::to_string(count) + " values where the header names " + std::to_string(cells_.size()) +
         ", separated by " + nameOfSeparator(separator_) +
         (broken ? "; none has a point: are there decimal commas?" : ""));
}

void CsvParser::set(std::vector<double>& row, std::size_t column, double value,
                    std::string_view text) {
  const Cell& cell = cells_[column];
  if (cell.multiplier != 1) value *= cell.multiplier;
  if (cell.divisor != 1) value /= cell.divisor;
  if (!std::isfinite(value) && first_not_finite_.empty())
    first_not_finite_ = "line " + std::to_string(line_) + ": " + printableText(cell.name) + " is " +
                        (text.empty() ? "empty" : inQuotes(text));
  row[static_cast<std::size_t>(cell.target)] = value;
}

// The decimal sign is the same in the whole table, so "1,234" is never read as thousands.
double CsvParser::numberIn(std::string_view text, std::size_t column, bool may_have_comma) {
  const auto refuseNumber = [&](const std::string& cause) {
    refuse(printableText(cells_[column].name) + ": " + inQuotes(text) + cause);
  };
  const bool point = text.find('.') != std::string_view::npos;
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || !may_have_comma) {
    std::optional<double> value = parseNumber(text);
    const bool has_point = value && point;
    if (!value) value = foreignNumber(text);
    if (!value && separator_ == ',' && text.find(';') != std::string_view::npos)
      refuse(kDecimalComma);
    if (!value) refuseNumber(" is not a number");
    if (has_point && commas_)
      refuseNumber(" has a decimal point, numbers before it decimal commas");
    points_ |= has_point;
    return *value;
  }
  std::string with_point(text);
  with_point[comma] = '.';
  std::optional<double> value;
  if (!point) value = parseNumber(with_point);
  if (!value) value = foreignNumber(with_point);
  if (!value) refuseNumber(" is not a number: write one decimal sign and no thousands separators");
  if (points_) refuseNumber(" has a decimal comma, numbers before it decimal points");
  commas_ = true;
  return *value;
}

void CsvParser::readRow(std::string_view line, std::vector<double>& row) {
  const char* at = line.data();
  const char* const end = at + line.size();
  const auto isBlank = [this](char c) { return c == ' ' || (c == '\t' && separator_ != '\t'); };
  for (std::size_t column = 0;; ++column) {
    const bool read = column < cells_.size() && cells_[column].target >= 0;
    const char* const begin = at;
    while (read && at < end && isBlank(*at)) ++at;
    double value = 0;
    bool plain = false; // a number in the usual spelling
    if (read) {
      const auto [after, code] = std::from_chars(at, end, value);
      plain = code == std::errc{} && (after == end || *after == separator_);
      if (plain && !points_ && std::find(at, after, '.') != after) {
        points_ = !commas_;
        plain = points_;
      }
      if (plain) {
        set(row, column, value, {at, static_cast<std::size_t>(after - at)});
        at = after;
      }
    }
    if (!plain) {
      const void* const next =
          at < end ? std::memchr(at, separator_, static_cast<std::size_t>(end - at)) : nullptr;
      at = next ? static_cast<const char*>(next) : end;
      if (column == cells_.size()) {
        // Some programs end each row with a separator.
        const std::string_view rest = trimmed({begin, static_cast<std::size_t>(end - begin)});
        if (rest.empty()) return;
        refuseCount(line,
                    column + 1 + static_cast<std::size_t>(std::count(begin, end, separator_)));
      }
      const std::string_view text = trimmed({begin, static_cast<std::size_t>(at - begin)});
      if (read) set(row, column, numberIn(text, column, separator_ != ','), text);
    }
    if (at == end) {
      if (column + 1 < cells_.size()) refuseCount(line, column + 1);
      return;
    }
    ++at;
  }
}

void CsvParser::readQuotedRow(std::string_view line, std::vector<double>& row) {
  std::vector<std::string> texts = cellsOf(line, separator_);
  if (texts.empty()) refuse(kOpenQuote);
  if (texts.size() == cells_.size() + 1 && texts.back().empty()) texts.pop_back();
  if (texts.size() != cells_.size()) refuseCount(line, texts.size());
  for (std::size_t column = 0; column < texts.size(); ++column)
    if (cells_[column].target >= 0)
      set(row, column, numberIn(texts[column], column, true), texts[column]);
}

} // namespace patina
