#include "app/gui/scanning/scene_scans.h"

#include <algorithm>
#include <optional>

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
  list_->setStyleSheet(themed("QListWidget { border: 1px solid @line; }"));
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

void SceneScans::apply(const std::string& what, std::function<Scene(const Scene&)> edit) {
  if (edits_ == nullptr) return;
  edits_->edit(what, std::move(edit), [this](const std::string& problem) {
    emit failed(QString::fromStdString(problem));
  });
}

void SceneScans::put(const std::vector<SceneScan>& steps) {
  if (scene_ == nullptr || steps.empty()) return;
  const SceneScan* known = findScan(*scene_, steps.front().name);
  std::optional<SceneScan> before;
  if (known) before = *known;
  for (SceneScan step : steps) {
    if (known) step.files.insert(known->files.begin(), known->files.end()); // what it lacks
    const std::string words = wordsFor(before ? &*before : nullptr, step);
    if (words.empty()) continue;
    apply(words, [step](const Scene& now) { return withScan(now, step); });
    before = step;
  }
}

} // namespace patina
