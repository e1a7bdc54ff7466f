#include <algorithm>

#include "app/cli/commands/commands.h"
#include "app/cli/input/workspace_place.h"
#include "app/cli/output/reports.h"
#include "core/numbers.h"
#include "core/utc_time.h"
#include "session/store/journal_fold.h"
#include "session/store/replay.h"
#include "session/store/workspace_storage.h"

namespace patina::cli {

namespace {

struct HistoryOptions {
  std::filesystem::path workspace;
  int steps = 1;
  bool list = false;
};

enum class Way { back, forth };

const Keys kUndoKeys = {
    {"edits",
     "",
     "edits",
     "oldest first, with --list",
     Shown::never,
     {{"what", "", ""}, {"done", "", ""}, {"time", "", "UTC, where known"}}},
    {"untimed", "", "without a time", "edits of an older version, which kept none", Shown::if_any},
    {"undone", "", "undone", "by this command", Shown::if_any},
    {"redone", "", "redone", "by this command", Shown::if_any},
    {"history", "", "history", "edits that can be undone"},
    {"redo", "", "redo", "edits that can be redone", Shown::never}};

std::string describeEvent(const JournalEvent& event) {
  if (const auto* stroke = std::get_if<Stroke>(&event)) return describe(*stroke);
  if (const auto* values = std::get_if<ValueEdit>(&event)) return describe(*values);
  return std::get<StoredSceneEdit>(event).what;
}

void listEdits(const FoldedJournal& fold, Report& report) {
  Json edits = Json::array();
  std::size_t untimed = 0;
  for (std::size_t i = 0; i < fold.steps.size(); ++i) {
    const std::string what = describeEvent(*fold.steps[i].event);
    const bool done = i < fold.position;
    const std::int64_t time = fold.steps[i].event->time;
    Json edit = Json::object().set("what", what).set("done", done);
    if (time != 0) edit.set("time", formatUtc(time));
    edits.push(std::move(edit));
    const std::string when = time != 0 ? formatUtc(time) + "  " : "";
    report.tell(std::to_string(i + 1), when + what + (done ? "" : "  (undone)"));
    untimed += time == 0;
  }
  report.set("edits", edits);
  report.set("untimed", untimed);
}

struct Counts {
  std::size_t undoable = 0, redoable = 0, moved = 0;
};

// A replay is needed only if the scene there is not stored.
Counts move(const std::filesystem::path& folder, std::size_t steps, Way way, Console& console) {
  auto opened = WorkspaceStorage::open(folder, Replayer(), kHistoryBudget, true, false);
  EditHistory& history = *opened.history;
  steps = std::min(steps, way == Way::back ? history.undoable() : history.redoable());
  if (isRepeated(folder, opened.intents, console)) steps = 0; // another program has just done it
  if (steps > 0) {
    const std::size_t target =
        way == Way::back ? history.undoable() - steps : history.undoable() + steps;
    Scene scene = history.sceneAt(target);
    opened.storage->setIntent(console.intent);
    console.commit([&] {
      way == Way::back ? opened.storage->recordUndo(steps) : opened.storage->recordRedo(steps);
    });
    history.setPosition(target, std::move(scene));
    saveJournaled(folder, console, [&] { opened.storage->save(history); });
  }
  return {history.undoable(), history.redoable(), steps};
}

int runHistory(const HistoryOptions& options, Way way, Console& console) {
  if (options.list) console.warnOfNoEffect({"--steps"}, "with --list");
  const std::filesystem::path folder = workspaceFolder(options.workspace);
  Counts counts;
  bool repeated = false;
  Report report(kUndoKeys);
  {
    const OpenedWorkspace found = openHistory(folder);
    for (const std::string& note : found.notes) console.warn(note);
    const FoldedJournal fold = folded(found.journal, found.journal_file.string());
    counts = {fold.position, fold.steps.size() - fold.position, 0};
    repeated = !options.list && isRepeated(folder, intentsOf(found), console);
    if (options.list) listEdits(fold, report);
  }
  const std::size_t possible = way == Way::back ? counts.undoable : counts.redoable;
  if (!options.list && !repeated && possible > 0)
    counts = move(folder, static_cast<std::size_t>(options.steps), way, console);
  if (!options.list && !repeated && possible == 0)
    console.warn(folder.string() +
                 (way == Way::back ? ": there is nothing to undo" : ": there is nothing to redo"));
  const bool back = way == Way::back;
  report.set("undone", back ? counts.moved : 0).set("redone", back ? 0 : counts.moved);
  report.set("history", counts.undoable, historyText(counts.undoable, counts.redoable));
  report.set("redo", counts.redoable);
  return console.report(report);
}

Command historyCommand(Way way) {
  auto options = std::make_shared<HistoryOptions>();
  const bool back = way == Way::back;
  const std::string name = back ? "undo" : "redo";
  return {
      .name = name,
      .summary = back ? "take back edits of a workspace" : "do again what was undone",
      .description =
          std::string(back ? "Restores the workspace before its last edit, bit for bit; undone "
                             "edits can be redone until the next edit."
                           : "Restores the workspace before patina undo, bit for bit.") +
          " Edits are strokes, values set, and objects added, moved or removed. If there are fewer "
          "steps than asked for, all are taken; with none the folder stays as it is and the exit "
          "code is 0.",
      .examples = {"patina " + name + " cup", "patina " + name + " cup --steps 3",
                   "patina " + name + " cup --list"},
      .keys = kUndoKeys,
      .arguments = {input("WORKSPACE", "The folder.", into(options->workspace)),
                    {"--steps", "N", "", "1", "How many edits.",
                     numberInto(1, 1e9, options->steps, NumberKind::whole)},
                    {"--list", "", "", "", "Only print the history.", into(options->list)}},
      .run = [options, way](Console& console) { return runHistory(*options, way, console); },
      .changes_workspace = true};
}

} // namespace

Command undoCommand() {
  return historyCommand(Way::back);
}

Command redoCommand() {
  return historyCommand(Way::forth);
}

} // namespace patina::cli
