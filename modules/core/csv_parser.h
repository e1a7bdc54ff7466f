// Parses the rows of a table of numbers. The header names the columns, in any order; the separator,
// the decimal sign and the units follow from the text itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace patina {

// Columns that a reader needs, with the units in which it gets them: "t [s]", "qx".
struct CsvColumns {
  std::vector<std::string> required;
  std::vector<std::string> optional = {}; // NaN in each row if the table lacks the column
  std::vector<std::string> unread = {};   // belong to the format; leftOut() does not name them
  bool others = false;                    // append all other columns to the row
};

// Parses one line after another. The separator is the first of semicolon, tab and comma that occurs
// in the header; unless it is a comma, numbers may have decimal commas. Cells may be quoted, but
// end in their line. An empty cell, NA, N/A, null and the errors of spreadsheets are NaN. Throws
// FileError with the line and, if one is at fault, the column.
class CsvParser {
 public:
  CsvParser(std::string name, CsvColumns columns);
  // Counts a line that is neither header nor row.
  void skipLine() { ++line_; }
  // Does without a header: the required columns, and all optional ones if there are so many in the
  // line, follow in order and in their units, separated by commas.
  void assumeHeader(std::string_view line);

  // Returns true if the line is a row, and fills `row`: required, optional, other columns. Skips
  // blank lines, lines that begin with # or % and, before the header, "sep=;".
  bool take(std::string_view line, std::vector<double>& row);

  bool hasHeader() const { return has_header_; }
  std::size_t line() const { return line_; } // number of the last line, from 1
  const std::vector<std::string>& columns() const {
    return columns_;
  }                                          // columns as `row` holds them
  bool has(const std::string& column) const; // true if the table has this optional column

  // Returns the message for a text without a header.
  std::string emptyText() const;
  // Lists the table's columns that are not read, "a.csv: columns left out: b, c", or is empty.
  std::string leftOut() const;
  // First NaN or infinite value with its place, "line 7: y [m] is 'nan'"; empty if there is none.
  const std::string& firstNotFinite() const { return first_not_finite_; }

 private:
  struct Cell {
    std::string name;
    int target = -1; // index in the row; -1: not read
    double multiplier = 1, divisor = 1;
  };

  bool readHeader(std::string_view line);
  bool isComment(std::string_view line) const;
  bool findColumn(std::size_t wanted, std::vector<Cell>& cells, std::string& cause) const;
  void readRow(std::string_view line, std::vector<double>& row);
  void readQuotedRow(std::string_view line, std::vector<double>& row);
  void set(std::vector<double>& row, std::size_t column, double value, std::string_view text);
  double numberIn(std::string_view text, std::size_t column, bool may_have_comma);
  [[noreturn]] void refuse(const std::string& cause) const;
  [[noreturn]] void refuseCount(std::string_view line, std::size_t count) const;

  std::string name_;
  CsvColumns wanted_;
  std::vector<std::string> columns_;
  std::vector<bool> found_; // index: wanted column
  std::vector<Cell> cells_; // index: column of the table
  std::size_t line_ = 0;
  char separator_ = 0;
  bool has_header_ = false, points_ = false, commas_ = false;
  std::string first_not_finite_;
};

} // namespace patina
