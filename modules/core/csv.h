// Strict numeric CSV with one header row that carries units: "t [s],x [m],y [m],z [m]".
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace patina {

struct CsvTable {
  std::vector<std::string> columns;      // header names, with their units
  std::vector<std::vector<double>> rows; // each as long as columns
};

// Reads a table whose first columns must be `expected`, in order (more may follow). Throws
// FileError with the line for: wrong header, wrong count, not a number (a decimal comma is named as
// such).
CsvTable readCsv(const std::filesystem::path& path, const std::vector<std::string>& expected);
CsvTable parseCsv(const std::string& text, const std::string& name,
                  const std::vector<std::string>& expected);

// Atomic; numbers read back bit for bit.
void writeCsv(const std::filesystem::path& path, const CsvTable& table);

} // namespace patina
