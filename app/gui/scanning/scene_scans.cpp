#include "app/gui/scanning/scene_scans.h"

#include <algorithm>

#include <QVBoxLayout>

#include "app/gui/window/theme.h"
#include "core/error.h"

namespace patina {
namespace {

// "track, filter": what has been done with it.
QString stepsOf(const SceneScan& scan) {
  QStringList steps;
  for (const auto& [file, step] : kScanFiles) {
    const QString word = QString::fromUtf8(step.data(), static_cast<int>(step.size()));
    if (scan.text(std::string(file)) && !steps.contains(word)) steps.push_back(word);
  }
  return steps.join(QStringLiteral(", "));
}

} // namespace

SceneScans::SceneScans(QWidget* parent)
    : QWidget(parent), list_(new QListWidget(this)),
      put_(new QPushButton(tr("Put into workspace"), this)),
      open_(new QPushButton(tr("Open"), this)), remove_(new QPushButton(tr("Remove"), this)) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(6);
  list_->setObjectName(QStringLiteral("scene_scans"));
  list_->setToolTip(tr("Scans of the workspace, with the files that each has; frames stay where "
                       "they are"));
  dress(*list_, QStringLiteral("QListWidget { border: 1px solid @line; }"));
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list_->setTextElideMode(Qt::ElideRight);
  put_->setObjectName(QStringLiteral("put_scan"));
  put_->setToolTip(tr("The scan, its calibration, poses and path become part of the scene: saved "
                      "with it, each step undone like any edit"));
  open_->setObjectName(QStringLiteral("open_scene_scan"));
  open_->setToolTip(tr("Show the chosen scan on this desk"));
  remove_->setObjectName(QStringLiteral("remove_scene_scan"));
  remove_->setToolTip(tr("Take the chosen scan out of the workspace; its folder stays"));
  column->addWidget(put_);
  column->addWidget(list_);
  auto* line = new QHBoxLayout;
  line->addWidget(open_);
  line->addWidget(remove_);
  column->addLayout(line);
  connect(put_, &QPushButton::clicked, this, &SceneScans::putAsked);
  connect(open_, &QPushButton::clicked, this, [this] {
    if (const SceneScan* scan = chosen()) emit openAsked(*scan);
  });
  connect(list_, &QListWidget::itemDoubleClicked, open_, &QPushButton::click);
  connect(remove_, &QPushButton::clicked, this, [this] {
    const SceneScan* scan = chosen();
    if (scan == nullptr) return;
    apply("remove scan " + scan->name,
          [name = scan->name](const Scene& now) { return withoutScan(now, name); });
  });
  refresh();
}

const SceneScan* SceneScans::chosen() const {
  const auto row = static_cast<std::size_t>(std::max(0, list_->currentRow()));
  return scene_ && row < scene_->scans.size() ? &scene_->scans[row] : nullptr;
}

void SceneScans::setScene(std::shared_ptr<const Scene> scene) {
  scene_ = std::move(scene);
  refresh();
}

void SceneScans::setOpen(bool scan) {
  scan_ = scan;
  refresh();
}

void SceneScans::refresh() {
  const int row = list_->currentRow();
  list_->clear();
  if (scene_)
    for (const SceneScan& scan : scene_->scans) {
      list_->addItem(QString::fromStdString(scan.name) + QStringLiteral(": ") + stepsOf(scan));
      list_->item(list_->count() - 1)->setToolTip(list_->item(list_->count() - 1)->text());
    }
  const int count = list_->count();
  if (count > 0) list_->setCurrentRow(std::clamp(row, 0, count - 1));
  list_->setFixedHeight(std::clamp(count, 1, 5) * std::max(18, list_->sizeHintForRow(0)) + 4);
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
      [this](const std::string& problem) { emit failed(QString::fromStdString(problem)); },
      std::move(done));
}

// `before` is what the scan is once all is done that was asked for so far, as far as is known here.
SceneScan SceneScans::ask(const std::string& name, const SceneScan* before, const Change& change,
                          std::function<void()> done) {
  SceneScan after = change(before);
  const std::string words = wordsFor(before, after);
  if (!words.empty())
    apply(
        words,
        [name, change](const Scene& now) { return withScan(now, change(findScan(now, name))); },
        std::move(done));
  else if (done)
    done(); // it is so already
  return after;
}

void SceneScans::tellLost(const SceneScan* before, const SceneScan& after) {
  if (const std::string lost = before ? filesLost(*before, after) : ""; !lost.empty())
    emit said({tr("Scan %1: %2 followed from what was replaced, and went with it; undo brings it "
                  "back")
                   .arg(QString::fromStdString(after.name), QString::fromStdString(lost))});
}

void SceneScans::change(const std::string& name, const Change& change, std::function<void()> done) {
  if (scene_ == nullptr) return;
  try {
    const SceneScan* before = findScan(*scene_, name);
    tellLost(before, ask(name, before, change, std::move(done)));
  } catch (const Error& error) {
    emit failed(QString::fromStdString(error.what()));
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
              // What stays beside the last step stays beside those on the way there.
              const SceneScan last = renewed(*now, whole);
              SceneScan next = step;
              for (const auto& file : now->files)
                if (const std::string* text = last.text(file.first); text && *text == *file.second)
                  next.files.insert(file);
              return next;
            });
  tellLost(known, after);
}

} // namespace patina
