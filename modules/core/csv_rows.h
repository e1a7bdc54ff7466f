// Tables of core/csv.h that come or go a line at a time.
#pragma once

#include "core/csv.h"

namespace patina {

// Of a text, which must outlive it.
CsvReader::Source sourceOfText(std::string_view text);
// One row of `due` numbers. Throws FileError(name, number).
void parseCsvRow(std::string_view line, std::size_t due, const std::string& name,
                 std::size_t number, std::vector<double>& row);
// Lines with their ends.
std::string csvHeader(const std::vector<std::string>& columns);
std::string csvRow(const std::vector<double>& row);

} // namespace patina
