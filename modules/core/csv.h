// Tables of numbers with one header row that carries units: "t [s],x [m],y [m],z [m]".
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/csv_parser.h"
#include "core/file.h"
#include "core/line_buffer.h"

namespace patina {

struct CsvTable {
  std::vector<std::string> columns;      // header names, with their units
  std::vector<std::vector<double>> rows; // each as long as columns
};

// Reads a table row by row in constant memory; see CsvParser. The text is UTF-8, or UTF-16 with a
// byte order mark. Lines of more than 1 MB are rejected. All members throw FileError.
class CsvReader {
 public:
  // Fills a buffer and returns the number of bytes; 0 at the end.
  using Source = std::function<std::size_t(char* buffer, std::size_t capacity)>;

  CsvReader(const std::filesystem::path& path, const CsvColumns& columns);
  CsvReader(Source source, std::string name, const CsvColumns& columns);

  bool next(std::vector<double>& row); // returns false at the end
  double fraction() const; // share of the file's bytes read; 0 if the size is unknown (a pipe)

  const std::vector<std::string>& columns() const { return parser_.columns(); }
  bool has(const std::string& column) const { return parser_.has(column); }
  std::size_t line() const { return parser_.line(); } // number of the last row's line, from 1
  std::string leftOut() const { return parser_.leftOut(); }
  const std::string& firstNotFinite() const { return parser_.firstNotFinite(); }

 private:
  bool nextLine(std::string_view& line);

  Source source_;
  std::string name_;
  CsvParser parser_;
  LineBuffer lines_;
  bool ended_ = false;
  double bytes_ = 0, size_ = 0;
};

// Reads a text that must outlive the source.
CsvReader::Source sourceOfText(std::string_view text);

// Reads the whole table: the required columns first, then all others, which must hold numbers too.
CsvTable readCsv(const std::filesystem::path& path, const std::vector<std::string>& required);
CsvTable parseCsv(const std::string& text, const std::string& name,
                  const std::vector<std::string>& required);

// Writes a table row by row through an AtomicFile. Numbers read back bit for bit.
class CsvWriter {
 public:
  CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns);
  void add(const std::vector<double>& row);
  void commit();

 private:
  AtomicFile file_;
  std::string text_; // not yet in the file
};
void writeCsv(const std::filesystem::path& path, const CsvTable& table);
// Lines of such a table, including the line ends.
std::string csvHeader(const std::vector<std::string>& columns);
std::string csvRow(const std::vector<double>& row);

} // namespace patina
