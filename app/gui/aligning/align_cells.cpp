#include "app/gui/aligning/align_cells.h"

#include <QGridLayout>
#include <QShortcut>
#include <QVBoxLayout>

namespace patina {

AlignCells::AlignCells() {
  auto* empty = new QWidget;
  auto* column = new QVBoxLayout(empty);
  empty_->setWordWrap(true);
  empty_->setAlignment(Qt::AlignCenter);
  column->addStretch(1);
  column->addWidget(empty_);
  column->addWidget(offer_, 0, Qt::AlignCenter);
  column->addStretch(1);
  offer_->setObjectName(QStringLiteral("align_mesh"));
  connect(offer_, &QPushButton::clicked, this,
          [this] { emit meshAsked(QString::fromStdString(offered_.string())); });
  addWidget(empty);
}

void AlignCells::makeViews() {
  auto* page = new QWidget;
  auto* grid = new QGridLayout(page);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setSpacing(4);
  const std::tuple<const char*, QString, ViewPreset> kViews[] = {
      {"align_top", tr("Top"), ViewPreset::plus_z},
      {"align_bottom", tr("Bottom"), ViewPreset::minus_z},
      {"align_front", tr("Front"), ViewPreset::minus_y},
      {"align_back", tr("Back"), ViewPreset::plus_y}};
  for (const auto& [name, words, from] : kViews) {
    const int i = static_cast<int>(views_.size());
    auto* view = new AlignView(name, from);
    view->setToolTip(tr("Drag an arrow to shift the path along it, a ring to turn it about its "
                        "axis, the ball to shift it freely; beside them the picture"));
    auto* cell = new QVBoxLayout;
    cell->setSpacing(1);
    auto* caption = new QLabel(words);
    caption->setContentsMargins(6, 0, 0, 0);
    cell->addWidget(caption);
    cell->addWidget(view, 1);
    grid->addLayout(cell, i / 2, i % 2);
    views_.push_back(view);
    connect(view, &AlignView::dragBegun, this, &AlignCells::dragBegun);
    connect(view, &AlignView::dragged, this, &AlignCells::dragged);
    connect(view, &AlignView::dropped, this, &AlignCells::dropped);
    connect(view, &AlignView::clicked, this, &AlignCells::clicked);
  }
  for (int i = 0; i < 2; ++i) grid->setRowStretch(i, 1), grid->setColumnStretch(i, 1);
  addWidget(page);
  auto* escape = new QShortcut(Qt::Key_Escape, page);
  escape->setContext(Qt::WidgetWithChildrenShortcut);
  connect(escape, &QShortcut::activated, this, &AlignCells::escaped);
}

void AlignCells::offerMesh(const std::filesystem::path& file) {
  offered_ = file;
  offer_->setText(tr("Open the scan's %1").arg(QString::fromStdString(file.filename().string())));
  offer_->setVisible(!offered_.empty() && has_path_);
}

void AlignCells::showMissing(bool has_path) {
  has_path_ = has_path;
  empty_->setText(has_path ? tr("There is a path, and no mesh to lay it onto.\n\nOpen the mesh "
                                "that was scanned: Ctrl + O.")
                           : tr("A scan's path is laid onto the mesh here.\n\nOpen a scan on the "
                                "desk Scan, or a path.csv by Open path."));
  offerMesh(offered_);
  setCurrentIndex(0);
}

void AlignCells::showMesh(const std::shared_ptr<const TriangleMesh>& mesh) {
  if (views_.empty()) makeViews();
  setCurrentIndex(1);
  for (AlignView* view : views_) view->picture().setMesh(mesh);
}

void AlignCells::setPicking(bool picks) {
  for (AlignView* view : views_) view->setPicking(picks);
  if (picks) views_[0]->setFocus(); // Esc is the picture's
}

void AlignCells::draw(DrawnPath path, const std::vector<DrawnMark>& marks,
                      const std::optional<Vec3>& handle) {
  for (AlignView* view : views_) {
    path.bar = view == views_[1];
    view->picture().setPath(path);
    view->picture().setMarks(marks);
    view->picture().handle().setPlace(handle);
    view->picture().setDirty();
  }
}

void AlignCells::setMeshValues(const std::vector<float>& values) {
  for (AlignView* view : views_) view->picture().setMeshValues(values);
}

void AlignCells::fit() {
  for (AlignView* view : views_) view->fit();
}

void AlignCells::refresh() {
  for (AlignView* view : views_) view->refresh();
}

} // namespace patina
