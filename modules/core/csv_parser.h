// Rows of a table of numbers from its lines. The header's names decide which column is which, in
// any order; the separator, the decimal sign and the units follow from the text itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace patina {

// The columns that a reader asks for, with the units in which it gets them: "t [s]", "qx".
struct CsvColumns {
  std::vector<std::string> required;
  std::vector<std::string> optional = {}; // NaN in each row of a table without them
  std::vector<std::string> unread = {};   // belong to the format; leftOut() does not name them
  bool others = false;                    // append all other columns to the row
};

// Takes one line after the other. A table's separator is a semicolon, a tab or a comma, in this
// order, whichever its header has first; where that is no comma, numbers may have decimal commas.
// Cells may be in quotes. Throws FileError with the line, and the column where there is one.
class CsvParser {
 public:
  CsvParser(std::string name, CsvColumns columns);
  // Counts a line in place of the header: the required columns in their order, separated by commas.
  void skipHeader();

  // Returns true if the line is a row, and fills `row`: required, optional, other columns. Before
  // the header "sep=;" and lines that begin with # are passed over; blank lines are anywhere.
  bool take(std::string_view line, std::vector<double>& row);

  bool hasHeader() const { return has_header_; }
  std::size_t line() const { return line_; } // the number of the last line, from 1
  const std::vector<std::string>& columns() const { return columns_; } // of a row
  bool has(const std::string& column) const;                           // an optional one

  // Says of a text without a header what one must have.
  std::string emptyText() const;
  // Names the columns that the table has and no row holds: "a.csv: columns left out: b, c"; empty
  // if there are none.
  std::string leftOut() const;
  // The place of the first value that is NaN or infinite: "line 7: y [m] is 'nan'"; empty if none.
  const std::string& firstNotFinite() const { return first_not_finite_; }

 private:
  struct Cell {
    std::string name;
    int target = -1; // index in the row; -1: left out
    double multiplier = 1, divisor = 1;
  };

  bool readHeader(std::string_view line);
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
  std::vector<bool> found_; // by wanted column
  std::vector<Cell> cells_; // by the table's column
  std::size_t line_ = 0;
  char separator_ = 0;
  bool has_header_ = false, points_ = false, commas_ = false;
  std::string first_not_finite_;
};

} // namespace patina
