#include "app/cli/input/stroke_script.h"

#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "session/store/journal_fold.h"

namespace patina::cli {

namespace {

std::vector<Stroke> strokesOfJournal(const std::string& text, const std::string& name,
                                     Console& console) {
  const JournalText journal = parseJournal(text);
  if (journal.damaged_line) throw FileError(name, journal.damaged_line, journal.damage);
  if (journal.torn) console.warn(name + ": its last record was not finished and is left out");
  const FoldedJournal fold = folded(journal.events, name);
  std::vector<Stroke> strokes;
  const std::size_t heading = journal.from.empty() ? 0 : 1;
  for (std::size_t i = 0; i < fold.position; ++i) {
    const auto* stroke = std::get_if<Stroke>(fold.steps[i].event);
    if (!stroke) continue;
    try {
      requireSamples(*stroke);
    } catch (const Error& error) {
      throw FileError(name, fold.steps[i].number + heading, error.what());
    }
    strokes.push_back(*stroke);
  }
  if (const std::size_t others = fold.position - strokes.size())
    console.warn(name + ": " + formatCount(others) + (others == 1 ? " edit is" : " edits are") +
                 " no stroke and left out");
  return strokes;
}

} // namespace

std::vector<ScriptStroke> readScript(const std::filesystem::path& path, Console& console) {
  const std::string name = path.string();
  const std::string text = readFile(path);
  const bool journal =
      path.extension() == ".jsonl" || (isStandardStream(path) && text.starts_with(R"({"n":)"));
  std::vector<Stroke> strokes =
      journal ? strokesOfJournal(text, name, console) : parseStrokes(text, name);
  std::vector<ScriptStroke> script;
  for (Stroke& stroke : strokes) {
    std::string where = name + ": stroke " + std::to_string(script.size() + 1);
    script.push_back({std::move(stroke), std::move(where)});
  }
  return script;
}

} // namespace patina::cli
