#include "core/work_precision.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/file.h"
#include "core/numbers.h"
#include "core/version.h"

namespace patina {
namespace {

std::string plain(const Json& value) {
  if (value.isString()) return value.asString();
  return value.dump(-1);
}

// Names in order of first appearance; rows of one study may have different extra columns.
template <typename Select>
std::vector<std::string> namesOf(const WorkPrecisionTable& table, Select select) {
  std::vector<std::string> names;
  for (const WorkPrecisionRow& row : table.rows) {
    for (const auto& entry : select(row)) {
      if (std::find(names.begin(), names.end(), entry.first) == names.end())
        names.push_back(entry.first);
    }
  }
  return names;
}

std::vector<std::string> settingNames(const WorkPrecisionTable& table) {
  return namesOf(
      table, [](const WorkPrecisionRow& row) -> const auto& { return row.settings; });
}
std::vector<std::string> moreNames(const WorkPrecisionTable& table) {
  return namesOf(
      table, [](const WorkPrecisionRow& row) -> const auto& { return row.more; });
}

std::vector<std::string> header(const WorkPrecisionTable& table) {
  std::vector<std::string> names = settingNames(table);
  names.push_back("error [" + table.error_unit + "]");
  names.push_back("error_max [" + table.error_unit + "]");
  names.emplace_back("ns");
  names.emplace_back("bytes");
  for (std::string& name : moreNames(table)) names.push_back(std::move(name));
  names.emplace_back("program");
  return names;
}

std::vector<std::string> cells(const WorkPrecisionTable& table, const WorkPrecisionRow& row) {
  std::vector<std::string> line;
  for (const std::string& name : settingNames(table)) {
    std::string cell;
    for (const auto& [key, value] : row.settings)
      if (key == name) cell = plain(value);
    line.push_back(std::move(cell));
  }
  for (const double value : {row.error, row.error_max, row.ns, row.bytes})
    line.push_back(formatNumber(value));
  for (const std::string& name : moreNames(table)) {
    std::string cell;
    for (const auto& [key, value] : row.more)
      if (key == name) cell = formatNumber(value);
    line.push_back(std::move(cell));
  }
  line.push_back(versionText());
  return line;
}

std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

} // namespace

double fittedOrder(const std::vector<double>& h, const std::vector<double>& error) {
  if (h.size() != error.size() || h.size() < 2)
    throw std::invalid_argument("fittedOrder: two or more pairs are needed");
  double mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < h.size(); ++i) {
    if (!(h[i] > 0) || !(error[i] > 0) || !std::isfinite(h[i]) || !std::isfinite(error[i]))
      throw std::invalid_argument("fittedOrder: values must be positive and finite");
    mean_x += std::log(h[i]) / static_cast<double>(h.size());
    mean_y += std::log(error[i]) / static_cast<double>(h.size());
  }
  double xy = 0, xx = 0;
  for (std::size_t i = 0; i < h.size(); ++i) {
    const double dx = std::log(h[i]) - mean_x;
    xy += dx * (std::log(error[i]) - mean_y);
    xx += dx * dx;
  }
  if (!(xx > 0)) throw std::invalid_argument("fittedOrder: all steps are equal");
  return xy / xx;
}

Json toJson(const WorkPrecisionTable& table) {
  Json rows = Json::array();
  for (const WorkPrecisionRow& row : table.rows) {
    Json line = Json::object();
    for (const auto& [key, value] : row.settings) line.set(key, value);
    line.set("error", row.error).set("error_max", row.error_max);
    line.set("ns", row.ns).set("bytes", row.bytes);
    for (const auto& [key, value] : row.more) line.set(key, value);
    rows.push(std::move(line));
  }
  Json json = Json::object();
  json.set("study", table.study).set("title", table.title).set("error_unit", table.error_unit);
  json.set("program", programDescription()).set("machine", machineDescription());
  json.set("rows", std::move(rows));
  json.set("order_fitted", table.order_fitted ? Json(*table.order_fitted) : Json());
  json.set("order_expected", table.order_expected ? Json(*table.order_expected) : Json());
  return json;
}

void writeCsv(const std::filesystem::path& path, const WorkPrecisionTable& table) {
  std::string text;
  const auto append = [&](const std::vector<std::string>& line) {
    for (std::size_t i = 0; i < line.size(); ++i) text += (i > 0 ? "," : "") + csvCell(line[i]);
    text += '\n';
  };
  append(header(table));
  for (const WorkPrecisionRow& row : table.rows) append(cells(table, row));
  writeFileAtomically(path, text);
}

} // namespace patina
