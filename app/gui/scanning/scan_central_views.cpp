#include "app/gui/scanning/scan_central_views.h"

#include <QVBoxLayout>

#include "app/gui/scanning/found_files.h"
#include "app/gui/toolkit/words.h"
#include "core/numbers.h"
#include "core/percentiles.h"

namespace patina {
namespace {

QString countWords(std::size_t count) {
  return QLocale(QLocale::English).toString(static_cast<qulonglong>(count));
}

double lengthOf(const std::vector<PathSample>& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    if (path[i].t - path[i - 1].t < 0.1) length += (path[i].position - path[i - 1].position).norm();
  return length;
}

} // namespace

ScanPanel::ScanPanel(OpenScan& scan, QWidget* parent)
    : QGroupBox(tr("Scan"), parent), scan_(scan), shown_(new QWidget(this)),
      color_(
          named(new QComboBox(this), "path_color", tr("Quantity shown by the colour of the path"))),
      mesh_(named(new QCheckBox(tr("Mesh"), this), "scan_mesh",
                  tr("The scanned mesh, if its pose is known"))),
      camera_(named(new QCheckBox(tr("Camera"), this), "scan_camera",
                    tr("Pose and field of view of the camera"))) {
  auto* column = layoutIn<QVBoxLayout>(this);
  auto* line = layoutIn<QGridLayout>(shown_);
  line->addWidget(quietLabel(tr("Path coloured by")), 0, 0);
  line->addWidget(color_, 0, 1);
  line->addWidget(mesh_, 1, 0);
  line->addWidget(camera_, 1, 1);
  for (const PathColor color : {PathColor::force, PathColor::sigma, PathColor::time})
    color_->addItem(captionOf(color));
  mesh_->setChecked(true);
  camera_->setChecked(true);
  column->addWidget(shown_);
  addButton(column, "open_scan", tr("Open scan…"),
            tr("A folder of frames, poses, a probe's stream or a path"), this,
            &ScanPanel::openRequested);
  keep_ = addButton(column, "keep_path", tr("Keep poses and path"),
                    tr("Writes poses.tum and path.csv into the scan's folder, like patina track "
                       "and patina filter. Existing files stay."),
                    this, &ScanPanel::keepRequested);
  texture_ = addButton(
      column, "scan_texture", tr("Texture of this scan"),
      tr("Runs the remaining steps, like patina scan: registers the path with the open mesh, and "
         "maps the scanned texture onto it. The scene's own stiffness stays"),
      this, &ScanPanel::textureRequested);
  close_ = addButton(column, "close_scan", tr("Close scan"), tr("Closes the scan; its files stay"),
                     this, &ScanPanel::closeRequested);
  connect(color_, qOverload<int>(&QComboBox::currentIndexChanged), this, &ScanPanel::shownChanged);
  for (QCheckBox* box : {mesh_, camera_})
    connect(box, &QCheckBox::toggled, this, &ScanPanel::shownChanged);
  for (const auto signal : {&OpenScan::opened, &OpenScan::pathMade, &OpenScan::finished})
    connect(&scan_, signal, this, &ScanPanel::refresh);
  refresh();
}

void ScanPanel::refresh() {
  delete figures_;
  figures_ = new FactTable(this);
  static_cast<QVBoxLayout*>(layout())->insertWidget(0, figures_);
  const bool open = scan_.files() != nullptr;
  if (open) fill();
  figures_->setVisible(open);
  shown_->setVisible(open);
  close_->setVisible(open);
  keep_->setVisible(open && canSaveResults(scan_));
  texture_->setVisible(open && scan_.path() != nullptr && !scan_.path()->filtered.whole.empty());
}

void ScanPanel::fill() {
  const ScanFiles& files = *scan_.files();
  figures_->row(files.of_scene ? tr("Workspace") : tr("Folder"), scan_.name(),
                shownText(files.problem));
  if (files.camera)
    figures_->row(tr("Camera"), tr("%1 × %2").arg(files.camera->width).arg(files.camera->height));
  if (!files.frames.empty()) figures_->row(tr("Frames"), countWords(files.frames.size()));
  if (files.frames.size() > 0 && !files.camera)
    figures_->row(tr("Tracking"), tr("needs a camera.yml"));
  else if (files.frames.size() > 0 && files.markers.empty())
    figures_->row(tr("Tracking"), tr("needs markers in rig.json"));
  const ScanPath* path = scan_.path();
  if (path == nullptr) return;
  const std::size_t used = path->filtered.track.used();
  const std::size_t rejected = path->filtered.track.verdicts.size() - used;
  figures_->row(
      tr("Poses"),
      rejected > 0 ? tr("%1, %2 rejected").arg(countWords(path->poses.size()), countWords(rejected))
                   : countWords(path->poses.size()));
  if (!files.probe.empty())
    figures_->row(tr("Probe"), tr("%1 samples").arg(countWords(files.probe.size())));
  if (path->path.empty()) return;
  std::vector<double> sigmas;
  for (const PathSample& sample : path->path) sigmas.push_back(sample.sigma);
  figures_->row(
      tr("Path"),
      tr("%1 samples, %2").arg(countWords(path->path.size()), inWords(lengthOf(path->path))),
      tr("Samples in contact, and the length of their path"));
  figures_->row(
      tr("Sigma"),
      tr("%1, at most %2").arg(inWords(percentiles(sigmas).p50), inWords(percentiles(sigmas).max)),
      tr("Standard deviation of the tip position: median and maximum"));
  const std::size_t gaps = path->filtered.without_pose.size(),
                    dropouts = path->filtered.without_sample.size();
  if (gaps + dropouts > 0)
    figures_->row(tr("Gaps"), tr("%1 of poses, %2 of the probe").arg(gaps).arg(dropouts));
}

ScanCentralViews::ScanCentralViews(OpenScan& scan, ScanPanel& panel)
    : scan_(scan), panel_(panel), frame_(new FrameView(scan)) {
  addWidget(first_hour_);
  across_->addWidget(frame_);
  across_->setChildrenCollapsible(false);
  across_->setHandleWidth(4);
  across_->setObjectName(QStringLiteral("scan_cells"));
  addWidget(across_);
  connect(&scan_, &OpenScan::opened, this, &ScanCentralViews::takeScan);
  connect(&scan_, &OpenScan::pathMade, this, [this] {
    drawPath();
    drawProbe();
  });
  connect(&scan_.cursor(), &ScanCursor::moved, this, &ScanCentralViews::drawProbe);
  connect(&panel_, &ScanPanel::shownChanged, this, [this] {
    drawPath();
    drawMesh();
  });
}

void ScanCentralViews::takeScan() {
  const bool open = scan_.files() != nullptr;
  if (view_ == nullptr && open) {
    view_ = new ScanView;
    view_->setToolTip(tr("The tip's path. Click a point to go to its time."));
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

void ScanCentralViews::setSceneMesh(std::shared_ptr<const TriangleMesh> mesh) {
  if (mesh == scene_mesh_) return;
  scene_mesh_ = std::move(mesh);
  drawMesh();
}

void ScanCentralViews::drawMesh() {
  if (view_ == nullptr || scan_.files() == nullptr) return;
  const ScanFiles& files = *scan_.files();
  std::shared_ptr<const TriangleMesh> mesh;
  if (files.mesh_from_camera) mesh = files.mesh ? files.mesh : scene_mesh_;
  panel_.setHasMesh(mesh != nullptr);
  view_->picture().setMesh(panel_.showsMesh() ? mesh : nullptr);
  view_->picture().setCamera(panel_.showsCamera() ? std::optional(drawnCamera(files))
                                                  : std::nullopt);
}

void ScanCentralViews::drawPath() {
  if (view_ == nullptr || scan_.files() == nullptr) return;
  const ScanFiles& files = *scan_.files();
  const ScanPath* path = scan_.path();
  view_->picture().setPath(path ? drawnPath(files, *path, panel_.color()) : DrawnPath());
  view_->picture().setMarks(path ? drawnMarks(files, *path) : std::vector<DrawnMark>());
  if (looked_at_ || !(path || files.mesh)) return;
  looked_at_ = path != nullptr && (!scan_.grows() || path->path.size() > 60);
  view_->resetCamera(upOf(files));
}

void ScanCentralViews::drawProbe() {
  if (view_ == nullptr || scan_.files() == nullptr) return;
  const auto probe = scan_.cursor().probe();
  view_->picture().setProbe(
      probe ? std::optional(
                  DrawnProbe{pictureFromCamera(*scan_.files()) * *probe, scan_.files()->tip()})
            : std::nullopt);
}

} // namespace patina
