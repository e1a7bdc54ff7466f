#include "app/gui/scanning/scan_cells.h"

#include <QPushButton>
#include <QVBoxLayout>

#include "app/gui/scanning/scan_drawing.h"

namespace patina {

ScanCells::ScanCells(OpenScan& scan, ScanPanel& panel)
    : scan_(scan), panel_(panel), frame_(new FrameView(scan)) {
  makeEmpty();
  across_->addWidget(frame_);
  across_->setChildrenCollapsible(false);
  across_->setHandleWidth(4);
  across_->setObjectName(QStringLiteral("scan_cells"));
  addWidget(across_);
  connect(&scan_, &OpenScan::opened, this, &ScanCells::takeScan);
  connect(&scan_, &OpenScan::pathMade, this, [this] {
    drawPath();
    drawProbe();
  });
  connect(&scan_.cursor(), &ScanCursor::moved, this, &ScanCells::drawProbe);
  connect(&panel_, &ScanPanel::shownChanged, this, [this] {
    drawPath();
    drawMesh();
  });
}

void ScanCells::makeEmpty() {
  auto* empty = new QWidget;
  auto* column = new QVBoxLayout(empty);
  auto* words = new QLabel(tr("No scan is open. A scan is a folder with a camera's frames and a "
                              "probe's stream, or with poses of another program."));
  words->setWordWrap(true);
  words->setAlignment(Qt::AlignCenter);
  auto* open = new QPushButton(tr("Open scan…"));
  open->setObjectName(QStringLiteral("open_first_scan"));
  open->setToolTip(
      tr("A folder of frames, poses, a probe's stream or a path; one can be dropped on "
         "the window, too"));
  connect(open, &QPushButton::clicked, this, &ScanCells::openAsked);
  column->addStretch(1);
  column->addWidget(words);
  column->addWidget(open, 0, Qt::AlignCenter);
  column->addStretch(1);
  addWidget(empty);
}

void ScanCells::takeScan() {
  const bool open = scan_.files() != nullptr;
  if (view_ == nullptr && open) {
    view_ = new ScanView;
    view_->setToolTip(tr("The tip's path; a click on it goes there"));
    across_->addWidget(view_);
    across_->setSizes({2000, 3000});
    connect(view_, &ScanView::timePicked, &scan_.cursor(), &ScanCursor::set);
  }
  setCurrentIndex(open ? 1 : 0);
  looked_at_ = false;
  drawMesh();
  drawPath();
  drawProbe();
}

void ScanCells::setSceneMesh(std::shared_ptr<const TriangleMesh> mesh) {
  if (mesh == scene_mesh_) return;
  scene_mesh_ = std::move(mesh);
  drawMesh();
}

void ScanCells::drawMesh() {
  if (view_ == nullptr || scan_.files() == nullptr) return;
  const ScanFiles& files = *scan_.files();
  std::shared_ptr<const TriangleMesh> mesh;
  if (files.mesh_from_camera) mesh = files.mesh ? files.mesh : scene_mesh_;
  panel_.setHasMesh(mesh != nullptr);
  view_->picture().setMesh(panel_.showsMesh() ? mesh : nullptr);
  view_->picture().setCamera(panel_.showsCamera() ? std::optional(drawnCamera(files))
                                                  : std::nullopt);
}

void ScanCells::drawPath() {
  if (view_ == nullptr || scan_.files() == nullptr) return;
  const ScanFiles& files = *scan_.files();
  const ScanPath* path = scan_.path();
  view_->picture().setPath(path ? drawnPath(files, *path, panel_.color()) : DrawnPath());
  view_->picture().setMarks(path ? drawnMarks(files, *path) : std::vector<DrawnMark>());
  if (looked_at_ || !(path || files.mesh)) return;
  looked_at_ = path != nullptr && (!scan_.grows() || path->path.size() > 60);
  view_->lookAtAll(upOf(files));
}

void ScanCells::drawProbe() {
  if (view_ == nullptr || scan_.files() == nullptr) return;
  const auto probe = scan_.cursor().probe();
  view_->picture().setProbe(
      probe ? std::optional(
                  DrawnProbe{pictureFromCamera(*scan_.files()) * *probe, scan_.files()->tip()})
            : std::nullopt);
}

void ScanCells::fit() {
  if (view_ != nullptr && view_->isVisible()) view_->picture().fit();
}

void ScanCells::setView(ViewPreset view) {
  if (view_ != nullptr && view_->isVisible()) view_->picture().setView(view);
}

void ScanCells::refresh() {
  if (view_ != nullptr) view_->refresh();
}

} // namespace patina
