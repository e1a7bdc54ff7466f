// Strict numeric CSV with one header row that carries units: "t [s],x [m],y [m],z [m]".
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/file.h"

namespace patina {

struct CsvTable {
  std::vector<std::string> columns;      // header names, with their units
  std::vector<std::vector<double>> rows; // each as long as columns
};

// A table read a row at a time, in memory that does not grow with it. The first columns must be
// `expected`, in order (more may follow). All throw FileError with the line for: wrong header,
// wrong count, not a number (a decimal comma is named as such), a line of more than 1 MB.
class CsvReader {
 public:
  // Fills a buffer and says with how many bytes; 0 at the end.
  using Source = std::function<std::size_t(char* buffer, std::size_t room)>;

  CsvReader(const std::filesystem::path& path, const std::vector<std::string>& expected);
  CsvReader(Source source, std::string name, const std::vector<std::string>& expected);

  const std::vector<std::string>& columns() const { return columns_; }
  bool next(std::vector<double>& row);       // false at the end
  std::size_t line() const { return line_; } // of what was read last, from 1
  double fraction() const; // of the file's bytes; 0 where its size is not known (a pipe)

 private:
  bool nextLine(std::string_view& line);

  Source source_;
  std::string name_;
  std::vector<std::string> columns_;
  std::string buffer_; // what was read and not used yet begins at used_
  std::size_t used_ = 0, line_ = 0;
  bool ended_ = false;
  double bytes_ = 0, size_ = 0;
};

// The same as one value.
CsvTable readCsv(const std::filesystem::path& path, const std::vector<std::string>& expected);
CsvTable parseCsv(const std::string& text, const std::string& name,
                  const std::vector<std::string>& expected);

// A table written a row at a time; an AtomicFile. Numbers read back bit for bit.
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

} // namespace patina
