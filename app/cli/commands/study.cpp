#include "app/studies/study.h"

#include <algorithm>

#include "app/cli/commands/commands.h"
#include "app/cli/input/suggestion.h"
#include "app/cli/output/folded_table.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/file.h"
#include "core/staged_folder.h"
#include "visualization/plots/plot.h"
#include "visualization/view/display.h"

namespace patina::cli {

namespace {

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

// "field.csv", or "field-2.csv" where a study makes several tables.
std::string baseName(const Study& study, std::size_t index, std::size_t count) {
  const std::string name(study.name);
  return count == 1 ? name : name + "-" + std::to_string(index + 1);
}

// A table of orders alone has nothing to plot against time.
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
  // All of them before any is written: Ctrl-C leaves none.
  std::vector<std::vector<WorkPrecisionTable>> found;
  for (const Study& study : list)
    found.push_back(tablesOf(study, options.study, console.progress()));
  console.progress().throwIfCancelled();
  StagedFolder staged(folder, baseName(list.back(), found.back().size() - 1, found.back().size()) +
                                  ".json");

  Json tables = Json::array(), rows = Json::array(), files = Json::array();
  Json order_fitted, order_expected; // of the first table that has a theory to be held against
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
      text += foldedText(table) + "  " + (folder / base).string() + ".csv .json" +
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
