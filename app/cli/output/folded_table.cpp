#include "app/cli/output/folded_table.h"

#include <algorithm>
#include <cstdio>

#include "app/cli/output/help.h"

namespace patina::cli {

namespace {

struct Column {
  std::string name;
  bool setting = false; // stands in every block
  std::vector<std::string> cells;

  std::size_t width() const {
    std::size_t widest = name.size();
    for (const std::string& cell : cells) widest = std::max(widest, cell.size());
    return widest;
  }
  bool neverChanges() const {
    return std::ranges::all_of(cells, [&](const auto& cell) { return cell == cells.front(); });
  }
};

// Four digits: what a reader compares by eye. The files keep every digit.
std::string shortened(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::vector<Column> columnsOf(const WorkPrecisionTable& table) {
  std::vector<Column> columns;
  const std::size_t count = table.rows.size();
  const auto put = [&](std::size_t row, const std::string& name, bool setting, std::string cell) {
    auto column = std::ranges::find(columns, name, &Column::name);
    if (column == columns.end())
      column = columns.insert(columns.end(), {name, setting, std::vector<std::string>(count)});
    column->cells[row] = std::move(cell);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const WorkPrecisionRow& row = table.rows[i];
    for (const auto& [name, value] : row.knobs)
      put(i, name, true, value.isString() ? value.asString() : value.dump(-1));
    put(i, "error [" + table.error_unit + "]", false, shortened(row.error));
    put(i, "error_max [" + table.error_unit + "]", false, shortened(row.error_max));
    put(i, "ns", false, shortened(row.ns));
    put(i, "bytes", false, shortened(row.bytes));
    for (const auto& [name, value] : row.more) put(i, name, false, shortened(value));
  }
  return columns;
}

constexpr std::size_t kGap = 2;

std::string lineOf(const std::vector<const Column*>& columns, std::size_t row) {
  std::string line;
  for (const Column* column : columns) {
    const std::string& cell = row == 0 ? column->name : column->cells[row - 1];
    line += std::string((line.empty() ? 0 : kGap) + column->width() - cell.size(), ' ') + cell;
  }
  return line + "\n";
}

} // namespace

std::string foldedText(const WorkPrecisionTable& table, std::size_t width) {
  const std::vector<Column> columns = columnsOf(table);
  std::string title = table.title;
  std::vector<const Column*> settings, results;
  std::size_t settings_width = 0;
  for (const Column& column : columns) {
    if (table.rows.size() > 1 && column.neverChanges() && !column.name.starts_with("error")) {
      title += "; " + column.name + " " + column.cells.front();
    } else if (column.setting) {
      settings.push_back(&column);
      settings_width += column.width() + kGap;
    } else {
      results.push_back(&column);
    }
  }
  std::string text = wrapped(title, 2, 0, width) + "\n";
  for (auto next = results.begin(); next != results.end();) {
    std::vector<const Column*> block = settings;
    std::size_t used = settings_width;
    do {
      used += (*next)->width() + kGap;
      block.push_back(*next++);
    } while (next != results.end() && used + (*next)->width() <= width);
    for (std::size_t row = 0; row <= table.rows.size(); ++row) text += lineOf(block, row);
    if (next != results.end()) text += "\n";
  }
  if (table.order_fitted) {
    text += "order fitted " + shortened(*table.order_fitted);
    if (table.order_expected) text += ", expected " + shortened(*table.order_expected);
    text += "\n";
  }
  return text;
}

} // namespace patina::cli
