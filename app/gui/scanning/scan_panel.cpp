#include "app/gui/scanning/scan_panel.h"

#include <QVBoxLayout>

#include "app/gui/scanning/found_files.h"
#include "app/gui/widgets/elided_label.h"
#include "app/gui/widgets/words.h"
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
      color_(new QComboBox(this)), mesh_(new QCheckBox(tr("Mesh"), this)),
      camera_(new QCheckBox(tr("Camera"), this)), open_(new QPushButton(tr("Open scan…"), this)),
      keep_(new QPushButton(tr("Keep poses and path"), this)),
      texture_(new QPushButton(tr("Texture of this scan"), this)),
      close_(new QPushButton(tr("Close scan"), this)) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(6);
  auto* line = new QGridLayout(shown_);
  line->setContentsMargins(0, 0, 0, 0);
  auto* caption = new QLabel(tr("Path coloured by"), shown_);
  caption->setProperty("quiet", true);
  line->addWidget(caption, 0, 0);
  line->addWidget(color_, 0, 1);
  line->addWidget(mesh_, 1, 0);
  line->addWidget(camera_, 1, 1);
  for (const PathColor color : {PathColor::force, PathColor::sigma, PathColor::time})
    color_->addItem(captionOf(color));
  color_->setObjectName(QStringLiteral("path_color"));
  color_->setToolTip(tr("What the tube's colour says, as its bar has it"));
  mesh_->setObjectName(QStringLiteral("scan_mesh"));
  mesh_->setToolTip(tr("The mesh that was scanned, where it is known where the camera saw it"));
  mesh_->setChecked(true);
  camera_->setObjectName(QStringLiteral("scan_camera"));
  camera_->setToolTip(tr("Where the camera stood, and what it saw"));
  camera_->setChecked(true);
  open_->setObjectName(QStringLiteral("open_scan"));
  open_->setToolTip(tr("A folder of frames, poses, a probe's stream or a path"));
  keep_->setObjectName(QStringLiteral("keep_path"));
  keep_->setToolTip(tr("Writes poses.tum and path.csv into the scan's folder, as patina track and "
                       "patina filter do; what is there stays"));
  texture_->setObjectName(QStringLiteral("scan_texture"));
  texture_->setToolTip(
      tr("All that is left to do, as patina scan does it: finds where the path lies on "
         "the open mesh, and lays the texture that was scanned onto it. The "
         "scene's own stiffness stays"));
  close_->setObjectName(QStringLiteral("close_scan"));
  close_->setToolTip(tr("The scan goes from the window, and stays where it is on disk"));
  column->addWidget(shown_);
  for (QPushButton* button : {open_, keep_, texture_, close_}) column->addWidget(button);
  connect(open_, &QPushButton::clicked, this, &ScanPanel::openAsked);
  connect(keep_, &QPushButton::clicked, this, &ScanPanel::keepAsked);
  connect(texture_, &QPushButton::clicked, this, &ScanPanel::textureAsked);
  connect(close_, &QPushButton::clicked, this, &ScanPanel::closeAsked);
  connect(color_, qOverload<int>(&QComboBox::currentIndexChanged), this, &ScanPanel::shownChanged);
  for (QCheckBox* box : {mesh_, camera_})
    connect(box, &QCheckBox::toggled, this, &ScanPanel::shownChanged);
  for (const auto signal : {&OpenScan::opened, &OpenScan::pathMade, &OpenScan::finished})
    connect(&scan_, signal, this, &ScanPanel::refresh);
  refresh();
}

void ScanPanel::setHasMesh(bool has) {
  mesh_->setEnabled(has);
}

void ScanPanel::row(const QString& caption, const QString& value, const QString& tip) {
  const int at = grid_->rowCount();
  auto* name = new QLabel(caption, figures_);
  name->setProperty("quiet", true);
  auto* words = new ElidedLabel(figures_);
  words->setText(value);
  if (!tip.isEmpty()) name->setToolTip(tip);
  grid_->addWidget(name, at, 0);
  grid_->addWidget(words, at, 1);
}

void ScanPanel::refresh() {
  delete figures_;
  figures_ = new QWidget(this);
  grid_ = new QGridLayout(figures_);
  grid_->setContentsMargins(0, 0, 0, 0);
  grid_->setHorizontalSpacing(8);
  grid_->setVerticalSpacing(2);
  grid_->setColumnStretch(1, 1);
  static_cast<QVBoxLayout*>(layout())->insertWidget(0, figures_);
  const bool open = scan_.files() != nullptr;
  if (open) fill();
  figures_->setVisible(open);
  shown_->setVisible(open);
  close_->setVisible(open);
  keep_->setVisible(open && canKeep(scan_));
  texture_->setVisible(open && scan_.path() != nullptr && !scan_.path()->filtered.whole.empty());
}

void ScanPanel::fill() {
  const ScanFiles& files = *scan_.files();
  row(files.of_scene ? tr("Workspace") : tr("Folder"), scan_.name(),
      QString::fromStdString(files.problem));
  if (files.camera)
    row(tr("Camera"), tr("%1 × %2").arg(files.camera->width).arg(files.camera->height));
  if (!files.frames.empty()) row(tr("Frames"), countWords(files.frames.size()));
  if (files.frames.size() > 0 && !files.camera)
    row(tr("Tracking"), tr("needs a camera.yml"));
  else if (files.frames.size() > 0 && files.markers.empty())
    row(tr("Tracking"), tr("needs markers in rig.json"));
  const ScanPath* path = scan_.path();
  if (path == nullptr) return;
  const std::size_t used = path->filtered.track.used();
  const std::size_t rejected = path->filtered.track.verdicts.size() - used;
  row(tr("Poses"),
      rejected > 0 ? tr("%1, %2 rejected").arg(countWords(path->poses.size()), countWords(rejected))
                   : countWords(path->poses.size()));
  if (!files.probe.empty()) row(tr("Probe"), tr("%1 samples").arg(countWords(files.probe.size())));
  if (path->path.empty()) return;
  std::vector<double> sigmas;
  for (const PathSample& sample : path->path) sigmas.push_back(sample.sigma);
  row(tr("Path"),
      tr("%1 samples, %2").arg(countWords(path->path.size()), inWords(lengthOf(path->path))),
      tr("What touches, and its length"));
  row(tr("Sigma"),
      tr("%1, at most %2").arg(inWords(percentiles(sigmas).p50), inWords(percentiles(sigmas).max)),
      tr("Standard deviation of the tip's place: median and largest"));
  const std::size_t gaps = path->filtered.without_pose.size(),
                    dropouts = path->filtered.without_sample.size();
  if (gaps + dropouts > 0)
    row(tr("Gaps"), tr("%1 of poses, %2 of the probe").arg(gaps).arg(dropouts));
}

} // namespace patina
