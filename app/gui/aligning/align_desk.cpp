#include "app/gui/aligning/align_desk.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QGridLayout>
#include <QShortcut>
#include <QVBoxLayout>

#include "acquisition/registration/error_map.h"
#include "acquisition/registration/first_guess.h"
#include "acquisition/registration/rigid_fit.h"
#include "app/gui/aligning/fit_words.h"
#include "app/gui/scanning/scan_path.h"
#include "visualization/layers/scale_layer.h"

namespace patina {
namespace {

constexpr double kFinest = 1e-3;  // of the colours' scale [mm]
constexpr int kSettle = 350;      // after its last change a value is a step [ms]
constexpr double kLongest = 0.06; // of the mesh, that lines are stretched to
constexpr double kNoLine = 1e-9;  // [m]: shorter is rounding
constexpr double kSpread = 0.01;  // of the mesh, that three points are apart at least

} // namespace

AlignDesk::AlignDesk(QWidget& window)
    : QObject(&window), window_(window), fit_job_(this), basin_job_(this) {
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
  cells_->addWidget(empty);
  settle_.setSingleShot(true);
  connect(&settle_, &QTimer::timeout, this, &AlignDesk::settle);
  connect(panel_, &AlignPanel::openAsked, this, &AlignDesk::openDialog);
  connect(panel_, &AlignPanel::keepAsked, this, &AlignDesk::keepDialog);
  connect(panel_, &AlignPanel::storeAsked, this, &AlignDesk::store);
  connect(panel_, &AlignPanel::scanChosen, this, &AlignDesk::openScan);
  connect(panel_, &AlignPanel::edited, this, [this](const PoseValues& values) {
    if (!alignment_.isReady() || work_) return;
    alignment_.setPose(poseOf(values));
    found_.reset();
    forgetMap();
    stale_ = true;
    settle_.start(kSettle);
  });
  connect(panel_, &AlignPanel::pickToggled, this, &AlignDesk::setPicking);
  connect(panel_, &AlignPanel::fitAsked, this, &AlignDesk::registerFromHere);
  connect(panel_, &AlignPanel::beginAsked, this, [this] {
    move(middleOnMiddle(alignment_.target()->mesh(), alignment_.points()));
    settle();
  });
  connect(&fit_job_, &Background::progressed, this, [this](double fraction, const QString&) {
    if (!work_) return;
    work_->fraction = fraction;
    emit changed();
  });
  connect(panel_, &AlignPanel::shownChanged, this, [this] {
    if (!alignment_.isReady()) return;
    draw();
    drawMap();
  });
  begin();
}

void AlignDesk::makeViews() {
  if (!views_.empty()) return;
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
    connect(view, &AlignView::dragBegun, this, [this] { held_ = alignment_.pose(); });
    connect(view, &AlignView::dragged, this, [this](const Pose& motion) { move(motion * held_); });
    connect(view, &AlignView::dropped, this, &AlignDesk::settle);
    connect(view, &AlignView::clicked, this, &AlignDesk::pick);
  }
  for (int i = 0; i < 2; ++i) grid->setRowStretch(i, 1), grid->setColumnStretch(i, 1);
  cells_->addWidget(page);
  auto* escape = new QShortcut(Qt::Key_Escape, page);
  escape->setContext(Qt::WidgetWithChildrenShortcut);
  connect(escape, &QShortcut::activated, this, [this] { setPicking(false); });
}

void AlignDesk::setPath(const QString& name, std::vector<PathSample> path) {
  path = inContact(std::move(path));
  if (path.size() < 3) {
    emit said({tr("%1 has fewer than three samples in contact").arg(name), true});
    return;
  }
  cancel();
  name_ = name;
  alignment_.setPath(std::move(path));
  begin();
}

void AlignDesk::setSceneMesh(std::shared_ptr<const TriangleMesh> mesh) {
  cancel();
  alignment_.setMesh(std::move(mesh));
  begin();
}

void AlignDesk::begin() {
  settle_.stop();
  found_.reset();
  setPicking(false);
  panel_->setPath(name_, alignment_.path().size());
  panel_->setReady(alignment_.isReady(), false);
  panel_->setFit({});
  plot_->setBasin(std::nullopt);
  empty_->setText(alignment_.path().empty()
                      ? tr("A scan's path is laid onto the mesh here.\n\nOpen a scan on the desk "
                           "Scan, or a path.csv by Open path.")
                      : tr("There is a path, and no mesh to lay it onto.\n\nOpen the mesh that was "
                           "scanned: Ctrl + O."));
  offerMesh(offered_);
  cells_->setCurrentIndex(0);
  if (alignment_.isReady()) {
    makeViews();
    cells_->setCurrentIndex(1);
    const auto mesh = std::make_shared<const TriangleMesh>(alignment_.target()->mesh());
    for (AlignView* view : views_) view->picture().setMesh(mesh);
    reach_ =
        1.5 * alignment_.target()->extent() + alignment_.pose().translation().cwiseAbs().maxCoeff();
    draw();
    fit();
    lookAbout();
  }
  emit changed();
}

void AlignDesk::move(const Pose& pose) {
  if (!alignment_.isReady() || work_) return;
  alignment_.setPose(pose);
  settle_.stop();
  found_.reset();
  forgetMap();
  draw();
}

void AlignDesk::settle() {
  settleBy(std::nullopt);
}

void AlignDesk::settleBy(std::optional<Registration> fit) {
  if (!alignment_.isReady() || work_) return;
  settle_.stop();
  alignment_.commit();
  found_ = std::move(fit);
  panel_->setFit(found_ ? fitWords(*found_) : QString());
  draw();
  lookAbout();
  emit changed();
}

void AlignDesk::undo() {
  if (work_ || !alignment_.undo()) return;
  settle();
}

void AlignDesk::redo() {
  if (work_ || !alignment_.redo()) return;
  settle();
}

void AlignDesk::draw() {
  stale_ = false;
  const Pose& pose = alignment_.pose();
  const Residuals off = residualsOf(*alignment_.target(), alignment_.points(), pose);
  panel_->setResiduals(off);
  if (!settle_.isActive()) panel_->setValues(valuesOf(pose), reach_);
  DrawnPath path;
  path.title = tr("distance [mm]").toStdString();
  path.through = true;
  path.least_span = kFinest;
  double longest = 0;
  const auto add = [&](const Vec3& at, double distance, const Vec3& foot) {
    path.samples.push_back({static_cast<double>(path.samples.size()), at, 1e3 * std::abs(distance),
                            false, false, foot});
    longest = std::max(longest, (at - foot).norm());
  };
  if (found_) { // by its own numbers
    for (std::size_t i = 0; i < found_->misses.size(); ++i)
      if (found_->counts[i])
        add(pose * alignment_.path()[i].position, found_->misses[i].distance, found_->misses[i].at);
  } else {
    for (std::size_t i = 0; i < alignment_.points().size(); ++i)
      add(pose * alignment_.points()[i], off.distances[i], off.feet[i]);
  }
  const double room = kLongest * alignment_.target()->extent();
  const double stretch = longest > kNoLine ? std::max(1.0, roundLength(room / longest)) : 1;
  panel_->setStretch(panel_->linesShown() ? stretch : 0);
  path.stretch = panel_->linesShown() ? stretch : 0;
  std::vector<DrawnMark> marks;
  for (const Vec3& point : on_path_) marks.push_back({0, pose * point});
  for (const Vec3& point : on_mesh_) marks.push_back({0, point});
  for (AlignView* view : views_) {
    path.bar = view == views_[1];
    view->picture().setPath(path);
    view->picture().setMarks(marks);
    view->picture().handle().setPlace(picks_ ? std::nullopt : std::optional(alignment_.middle()));
    view->picture().setDirty();
  }
}

void AlignDesk::forgetMap() {
  if (error_.empty()) return;
  error_.clear();
  basin_job_.silence();
  drawMap();
}

void AlignDesk::drawMap() {
  std::vector<float> shown;
  if (panel_->mapShown())
    for (const float error : error_) shown.push_back(1e3F * error);
  for (AlignView* view : views_) view->picture().setMeshValues(shown);
}

void AlignDesk::lookAbout() {
  plot_->setBasin(std::nullopt);
  forgetMap();
  std::vector<double> rms;
  for (const Pose& step : alignment_.steps())
    rms.push_back(residualsOf(*alignment_.target(), alignment_.points(), step).rms);
  rms.resize(alignment_.done() + 1);
  plot_->setSteps(rms);
  basin_job_.start([this, target = alignment_.target(), points = alignment_.points(),
                    path = alignment_.path(), found = found_, pose = alignment_.pose()](
                       Progress& progress, const Background::Deliver& deliver) {
    try {
      const Registration at = found ? *found : registeredAt(*target, path, pose);
      deliver(false,
              [this, error = errorMapOf(target->mesh(), at, kErrorReach * target->extent())] {
                error_ = error;
                drawMap();
              });
      const Basin basin = basinOf(*target, points, pose, progress);
      deliver(true, [this, basin] { plot_->setBasin(basin); });
    } catch (const Cancelled&) {
      deliver(true, [] {});
    }
  });
}

void AlignDesk::registerFromHere() {
  if (!alignment_.isReady() || work_) return;
  alignment_.commit();
  settle_.stop();
  setPicking(false);
  const QString title = tr("Fitting the path");
  work_ = Work{title, title};
  panel_->setReady(true, true);
  emit changed();
  std::vector<Vec3> points;
  for (const PathSample& sample : alignment_.path()) points.push_back(sample.position);
  const RegistrationOptions options = fitOptions(alignment_);
  fit_job_.start([this, options, points, target = alignment_.target(), start = alignment_.pose()](
                     Progress& progress, const Background::Deliver& deliver) {
    const auto rest = [this] {
      work_.reset();
      panel_->setReady(alignment_.isReady(), false);
    };
    try {
      const Registration found = registerPath(*target, points, start, options, progress);
      deliver(true, [this, rest, found] {
        rest();
        move(found.mesh_from_path);
        settleBy(found);
      });
    } catch (const std::exception& error) {
      deliver(true, [this, rest, problem = QString::fromStdString(error.what())] {
        rest();
        panel_->setFit(problem);
        emit changed();
      });
    }
  });
}

void AlignDesk::cancel() {
  if (!work_) return;
  fit_job_.silence();
  work_.reset();
  panel_->setReady(alignment_.isReady(), false);
  emit changed();
}

void AlignDesk::setPicking(bool on) {
  picks_ = on && alignment_.isReady() && !work_;
  on_path_.clear();
  on_mesh_.clear();
  for (AlignView* view : views_) view->setPicking(picks_);
  if (picks_) views_[0]->setFocus(); // Esc is the picture's
  askForPoint();
  if (alignment_.isReady() && !views_.empty()) draw();
}

void AlignDesk::askForPoint() {
  panel_->setPicking(!picks_ ? QString()
                             : (on_path_.size() == on_mesh_.size()
                                    ? tr("%1 of 3: click a place on the path (Esc ends it)")
                                    : tr("%1 of 3: click the same place on the mesh"))
                                   .arg(on_mesh_.size() + 1));
}

void AlignDesk::pick(const Ray& sight, double reach) {
  if (!picks_) return;
  const auto isNew = [&](const std::vector<Vec3>& list, const Vec3& point) {
    return std::all_of(list.begin(), list.end(), [&](const Vec3& other) {
      return (other - point).norm() > kSpread * alignment_.target()->extent();
    });
  };
  if (on_path_.size() == on_mesh_.size()) {
    double nearest = reach;
    std::optional<Vec3> found;
    for (const Vec3& point : alignment_.points()) {
      const Vec3 away = alignment_.pose() * point - sight.origin;
      const double off = (away - away.dot(sight.direction) * sight.direction).norm();
      if (off >= nearest) continue;
      nearest = off;
      found = point;
    }
    if (found && isNew(on_path_, *found)) on_path_.push_back(*found);
  } else if (const auto hit =
                 alignment_.target()->tree().firstHit(sight.origin, sight.direction, INFINITY)) {
    const Vec3 point = sight.origin + hit->t * sight.direction;
    if (isNew(on_mesh_, point)) on_mesh_.push_back(point);
  }
  askForPoint();
  draw();
  if (on_mesh_.size() < 3) return;
  const Pose fitted = fitRigid(on_path_, on_mesh_);
  setPicking(false);
  move(fitted);
  settle();
}

void AlignDesk::fit() {
  for (AlignView* view : views_) view->fit();
}

void AlignDesk::refresh() {
  if (stale_) draw();
  for (AlignView* view : views_) view->refresh();
}

} // namespace patina
