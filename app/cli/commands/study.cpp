#include <algorithm>
#include <cstdio>
#include <string>

#include "app/cli/commands/commands.h"
#include "app/cli/framework/suggestion.h"
#include "app/cli/output/help.h"
#include "app/cli/output/reports.h"
#include "app/studies/framework/studies.h"
#include "core/error.h"
#include "core/file.h"
#include "core/staged_folder.h"
#include "core/work_precision.h"
#include "visualization/plots/plot.h"
#include "visualization/view/display.h"

namespace patina::cli {
namespace {

// Prints a study's table with any number of columns.
constexpr std::size_t kTableWidth = 120;

struct Column {
  std::string name;
  bool setting = false; // repeated in every block
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

// Four digits for reading; the files contain all digits.
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
    for (const auto& [name, value] : row.settings)
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

// Aligns columns within `width`; further columns follow in blocks with the same settings. A
// constant column is printed once, beside the title.
std::string wrappedTable(const WorkPrecisionTable& table, std::size_t width = kTableWidth) {
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

struct StudyCommandOptions {
  std::string name;
  std::filesystem::path output;
  StudyOptions study;
};

const Keys kStudyKeys = {
    {"rows", "", "rows", "of all tables: the settings, error, error_max, ns, bytes", Shown::never},
    {"order_fitted", "", "order fitted", "of the first table that has a theory", Shown::never},
    {"order_expected", "", "order expected", "", Shown::never},
    {"tables", "", "tables", "each with its own rows and orders", Shown::never},
    {"files", "", "files", "in the folder", Shown::never}};

std::vector<Study> chosen(const std::string& name) {
  std::vector<Study> list;
  for (const Study& study : studies())
    if (name == "all" || name == study.name) list.push_back(study);
  if (!list.empty()) return list;
  std::vector<std::string> known = namesIn(studies(), &Study::name);
  known.emplace_back("all");
  throw Error("unknown study '" + name + "'" + suggestion(name, known, ".") +
              " There are: " + joined(known));
}

bool canDraw(Console& console) {
  try {
    requireDisplay();
    return true;
  } catch (const Error& error) {
    console.warn("tables without plots: " + std::string(error.what()));
    return false;
  }
}

// "field.csv", or "field-2.csv" if a study makes several tables.
std::string baseName(const Study& study, std::size_t index, std::size_t count) {
  const std::string name(study.name);
  return count == 1 ? name : name + "-" + std::to_string(index + 1);
}

// A table without times has nothing to plot against time.
bool hasTimes(const WorkPrecisionTable& table) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [](const auto& row) { return row.ns > 0 && row.error > 0; });
}

void addRows(const Json& table, Json& rows) {
  for (const Json& row : table.at("rows").asArray()) {
    Json line = Json::object();
    line.set("study", table.at("study")).set("title", table.at("title"));
    for (const auto& [key, value] : row.asObject()) line.set(key, value);
    rows.push(std::move(line));
  }
}

int runStudy(const StudyCommandOptions& options, Console& console) {
  const std::vector<Study> list = chosen(options.name);
  const std::filesystem::path& folder = options.output;
  const bool draws = canDraw(console);
  // Computes all before writing any, so that Ctrl-C leaves no files.
  std::vector<std::vector<WorkPrecisionTable>> found;
  for (const Study& study : list)
    found.push_back(tablesOf(study, options.study, console.progress()));
  console.progress().throwIfCancelled();
  StagedFolder staged(folder, baseName(list.back(), found.back().size() - 1, found.back().size()) +
                                  ".json");

  Json tables = Json::array(), rows = Json::array(), files = Json::array();
  Json order_fitted, order_expected; // first table with an expected order
  std::string text;
  for (std::size_t k = 0; k < list.size(); ++k) {
    for (std::size_t i = 0; i < found[k].size(); ++i) {
      const WorkPrecisionTable& table = found[k][i];
      const std::string base = baseName(list[k], i, found[k].size());
      const Json json = toJson(table);
      writeCsv(staged.path() / (base + ".csv"), table);
      writeFileAtomically(staged.path() / (base + ".json"), json.dump() + "\n");
      files.push(base + ".csv");
      files.push(base + ".json");
      if (draws && hasTimes(table)) {
        writePlot(workPrecisionPlot(table), staged.path() / (base + ".png"));
        files.push(base + ".png");
      }
      if (order_expected.isNull() && table.order_expected) {
        order_fitted = json.at("order_fitted");
        order_expected = json.at("order_expected");
      }
      addRows(json, rows);
      tables.push(json);
      text += wrappedTable(table) + "  " + (folder / base).string() + ".csv .json" +
              (draws && hasTimes(table) ? " .png\n\n" : "\n\n");
    }
  }
  console.progress().throwIfCancelled();
  staged.commit();
  Report report(kStudyKeys);
  report.set("rows", rows).set("order_fitted", order_fitted).set("order_expected", order_expected);
  report.set("tables", tables).set("files", files);
  return console.report(report, kDone, text);
}

} // namespace

Command studyCommand() {
  auto options = std::make_shared<StudyCommandOptions>();
  std::string description = "NAME is all or one of:";
  for (const Study& study : studies())
    description += "\n" + std::string(study.name) + ": " + std::string(study.about) + ".";
  description +=
      "\n"
      "Each table becomes NAME-I.csv, NAME-I.json (with machine, compiler, scheduling policy and "
      "load) and, where there is a display, NAME-I.png; a study of one table leaves the number "
      "out. A wide table is printed in pieces. Measure on a quiet machine.";
  return {.name = "study",
          .summary = "error against run time: tables and plots",
          .description = description,
          .examples = {"patina study field -o studies", "patina study all -o studies --quick"},
          .keys = kStudyKeys,
          .arguments = {input("NAME", "Which study.",
                              [options](const std::string& text) {
                                (void)chosen(text);
                                options->name = text;
                              }),
                        outputTo(options->output, "FOLDER", "Where to; made if it is missing."),
                        {"--quick", "", "", "", "Coarser and fewer: seconds instead of minutes.",
                         into(options->study.quick)},
                        {"--thorough", "", "", "", "Ten times as many random touches: minutes.",
                         into(options->study.thorough)}},
          .run = [options](Console& console) { return runStudy(*options, console); }};
}

} // namespace patina::cli
