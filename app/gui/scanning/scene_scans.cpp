#include "app/gui/scanning/scene_scans.h"

#include <algorithm>

#include <QVBoxLayout>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"

namespace patina {
namespace {

// Lists the finished steps: "track, filter".
QString stepsOf(const SceneScan& scan) {
  QStringList steps;
  for (const auto& [file, step] : kScanFiles) {
    const QString word = shownText(step);
    if (scan.text(std::string(file)) && !steps.contains(word)) steps.push_back(word);
  }
  return steps.join(QStringLiteral(", "));
}

} // namespace

SceneScans::SceneScans(QWidget* parent) : QWidget(parent) {
  auto* column = layoutIn<QVBoxLayout>(this);
  put_ = addButton(column, "put_scan", tr("Put into workspace"),
                   tr("Stores the scan, its calibration, poses and path in the scene. They are "
                      "saved with it, and each step can be undone."),
                   this, &SceneScans::putRequested);
  list_ =
      addList(column, "scene_scans",
              tr("Scans of the workspace, with the files of each; frames stay in their folder"));
  auto* line = new QHBoxLayout;
  column->addLayout(line);
  open_ = addButton(line, "open_scene_scan", tr("Open"), tr("Opens the selected scan on this desk"),
                    this, [this] {
                      if (const SceneScan* scan = chosen()) emit openRequested(*scan);
                    });
  remove_ =
      addButton(line, "remove_scene_scan", tr("Remove"),
                tr("Removes the selected scan from the workspace; its folder stays"), this, [this] {
                  if (const SceneScan* scan = chosen())
                    apply("remove scan " + scan->name,
                          [name = scan->name](const Scene& now) { return withoutScan(now, name); });
                });
  connect(list_, &QListWidget::itemDoubleClicked, open_, &QPushButton::click);
  refresh();
}

const SceneScan* SceneScans::chosen() const {
  const auto row = static_cast<std::size_t>(std::max(0, list_->currentRow()));
  return scene_ && row < scene_->scans.size() ? &scene_->scans[row] : nullptr;
}

void SceneScans::refresh() {
  const int row = list_->currentRow();
  QStringList lines;
  if (scene_)
    for (const SceneScan& scan : scene_->scans)
      lines << shownText(scan.name) + QStringLiteral(": ") + stepsOf(scan);
  fillList(list_, lines);
  const int count = lines.size();
  if (count > 0) list_->setCurrentRow(std::clamp(row, 0, count - 1));
  for (QWidget* each :
       {static_cast<QWidget*>(list_), static_cast<QWidget*>(open_), static_cast<QWidget*>(remove_)})
    each->setVisible(count > 0);
  put_->setVisible(scan_ && scene_ != nullptr);
  setVisible(count > 0 || (scan_ && scene_ != nullptr));
}

void SceneScans::apply(const std::string& what, std::function<Scene(const Scene&)> edit,
                       std::function<void()> done) {
  if (edits_ == nullptr) return;
  edits_->edit(
      what, std::move(edit),
      [this](const std::string& problem) { emit failed(shownText(problem)); }, std::move(done));
}

// before: the scan after all edits that were requested so far.
SceneScan SceneScans::ask(const std::string& name, const SceneScan* before, const Change& change,
                          std::function<void()> done) {
  SceneScan after = change(before);
  const std::string words = describeChange(before, after);
  if (!words.empty())
    apply(
        words,
        [name, change](const Scene& now) { return withScan(now, change(findScan(now, name))); },
        std::move(done));
  else if (done)
    done(); // The scan is already like that.
  return after;
}

void SceneScans::reportLost(const SceneScan* before, const SceneScan& after) {
  if (const std::string lost = before ? invalidatedFiles(*before, after) : ""; !lost.empty())
    emit notified({tr("Scan %1: %2 depended on the replaced file and was removed; undo restores it")
                       .arg(shownText(after.name), shownText(lost))});
}

void SceneScans::change(const std::string& name, const Change& change, std::function<void()> done) {
  if (scene_ == nullptr) return;
  try {
    const SceneScan* before = findScan(*scene_, name);
    reportLost(before, ask(name, before, change, std::move(done)));
  } catch (const Error& error) {
    emit failed(shownText(error.what()));
  }
}

void SceneScans::put(const std::vector<SceneScan>& steps) {
  if (scene_ == nullptr || steps.empty()) return;
  const std::string& name = steps.front().name;
  const SceneScan* known = findScan(*scene_, name);
  SceneScan after;
  for (const SceneScan& step : steps)
    after =
        ask(name, &step == &steps.front() ? known : &after,
            [step, whole = steps.back()](const SceneScan* now) {
              if (now == nullptr) return step;
              // Files that stay valid after the last step also stay valid after the others.
              const SceneScan last = mergedScan(*now, whole);
              SceneScan next = step;
              for (const auto& file : now->files)
                if (const std::string* text = last.text(file.first); text && *text == *file.second)
                  next.files.insert(file);
              return next;
            });
  reportLost(known, after);
}

} // namespace patina
