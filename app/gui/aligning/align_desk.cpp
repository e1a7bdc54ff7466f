#include "app/gui/aligning/align_desk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "acquisition/registration/first_guess.h"
#include "app/gui/aligning/fit_words.h"
#include "app/gui/toolkit/words.h"
#include "visualization/layers/scale_layer.h"

namespace patina {
namespace {

constexpr std::size_t kMinSamples = 3; // Smallest number of samples that can be aligned.
constexpr double kMinColorSpan = 1e-3; // Smallest span of the colour scale [mm].
constexpr int kMoveEndDelay = 350;     // Time without a change that ends a move [ms].
constexpr double kMaxLineShare = 0.06; // Length of the longest line, as a fraction of the mesh.
constexpr double kNoLine = 1e-9;       // Shorter lines are rounding [m].

// A fit is good also where no advice can be given.
std::optional<ScanAdvice> adviceIfAny(const SurfaceTarget& target, const RegisteredScans& scans) {
  try {
    return adviceFor(target, scans);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

} // namespace

AlignDesk::AlignDesk(QWidget& window)
    : QObject(&window), fit_job_(this), picking_(alignment_), cost_profile_(alignment_),
      files_(window, alignment_, *panel_) {
  pause_timer_.setSingleShot(true);
  connect(&pause_timer_, &QTimer::timeout, this, [this] { finishMove(); });
  connect(&files_, &AlignFiles::notified, this, &AlignDesk::notified);
  connect(&files_, &AlignFiles::opened, this,
          [this](const QString& name, const AlignedPath& path) { takePath(name, path, true); });
  connect(&files_, &AlignFiles::saved, this, [this](const Pose& pose) { saved_pose_ = pose; });
  connect(panel_, &AlignPanel::storeRequested, this, [this] { files_.store(name_); });
  connect(central_views_, &AlignCentralViews::dragStarted, this,
          [this] { drag_start_ = alignment_.pose(); });
  connect(central_views_, &AlignCentralViews::dragged, this,
          [this](const Pose& motion) { move(motion * drag_start_); });
  connect(central_views_, &AlignCentralViews::dropped, this, [this] { finishMove(); });
  connect(central_views_, &AlignCentralViews::clicked, this, &AlignDesk::pick);
  connect(central_views_, &AlignCentralViews::pointed, this,
          [this](const std::optional<Ray>& sight, double reach) {
            const bool reads = sight && alignment_.isReady();
            emit underPointer(reads ? probeWords(*sight, reach) : QString());
          });
  connect(central_views_, &AlignCentralViews::escaped, this, [this] { setPicking(false); });
  connect(&cost_profile_, &CostProfileJob::errorChanged, this, &AlignDesk::drawMap);
  connect(panel_, &AlignPanel::edited, this, [this](const PoseValues& values) {
    if (!alignment_.isReady() || work_) return;
    alignment_.setPose(poseOf(values));
    cost_profile_.reset();
    stale_ = true;
    pause_timer_.start(kMoveEndDelay);
  });
  connect(panel_, &AlignPanel::pickToggled, this, &AlignDesk::setPicking);
  connect(panel_, &AlignPanel::fitRequested, this, &AlignDesk::registerFromHere);
  connect(panel_, &AlignPanel::beginRequested, this, [this] {
    move(alignCenters(alignment_.target()->mesh(), alignment_.points()));
    finishMove();
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

std::map<Panel, QWidget*> AlignDesk::panels() const {
  return {{Panel::align, panel_}, {Panel::cost_profile, cost_profile_.panel()}};
}

void AlignDesk::setPath(const QString& name, const AlignedPath& aligned) {
  std::vector<PathSample> path = inContact(aligned.path);
  if (path.size() < kMinSamples) {
    emit notified({tr("%1 has fewer than three samples in contact").arg(name), true});
    return;
  }
  cancel();
  name_ = name;
  alignment_.setPath(std::move(path), aligned.tip_radius);
  begin();
  if (!aligned.mesh_from_path || !alignment_.isReady()) return;
  move(*aligned.mesh_from_path);
  finishMove();
  saved_pose_ = alignment_.pose();
}

void AlignDesk::takePath(const QString& name, const AlignedPath& aligned, bool is_interactive) {
  if (!is_interactive) return setPath(name, aligned);
  const bool stands = offered_.has_value();
  offered_ = {name, aligned};
  if (stands) return; // The open question is now about this path.
  const bool replaces = inContact(aligned.path).size() >= kMinSamples;
  const bool goes_on = replaces && !confirmPlacement();
  const auto [newest, path] = *std::exchange(offered_, std::nullopt);
  if (!goes_on) setPath(newest, path);
}

bool AlignDesk::confirmPlacement() {
  if (isSaved()) return true;
  return files_.confirmDiscard(
      tr("The pose of %1 on the mesh is neither in a file nor in the workspace.").arg(name_));
}

void AlignDesk::setSceneMesh(std::shared_ptr<const TriangleMesh> mesh) {
  cancel();
  unseen_ = true;
  alignment_.setMesh(std::move(mesh));
  begin();
}

void AlignDesk::changeSceneMesh(std::shared_ptr<const TriangleMesh> mesh) {
  if (mesh == alignment_.mesh()) return; // A fit of this mesh stays valid.
  if (alignment_.steps().empty()) return setSceneMesh(std::move(mesh));
  cancel();
  alignment_.changeMesh(std::move(mesh));
  showNew();
}

void AlignDesk::begin() {
  pause_timer_.stop();
  saved_pose_ = alignment_.pose();
  panel_->setPath(name_, alignment_.path().size());
  showNew();
  if (alignment_.isReady()) central_views_->fit();
}

void AlignDesk::showNew() {
  setPicking(false);
  panel_->setReady(alignment_.isReady(), false);
  panel_->setFit({});
  if (alignment_.isReady()) {
    central_views_->showMesh(std::make_shared<const TriangleMesh>(alignment_.target()->mesh()));
    reach_ =
        1.5 * alignment_.target()->extent() + alignment_.pose().translation().cwiseAbs().maxCoeff();
    draw();
    cost_profile_.start();
  } else {
    central_views_->showMissing(!alignment_.path().empty());
  }
  emit changed();
}

void AlignDesk::move(const Pose& pose) {
  if (!alignment_.isReady() || work_) return;
  alignment_.setPose(pose);
  pause_timer_.stop();
  cost_profile_.reset();
  draw();
}

void AlignDesk::finishMove(std::optional<Registration> fit) {
  if (!alignment_.isReady() || work_) return;
  pause_timer_.stop();
  alignment_.commit(std::move(fit));
  showPlace();
}

void AlignDesk::showPlace() {
  const std::optional<Registration>& found = alignment_.found();
  panel_->setFit(found ? fitWords(*found) : QString());
  draw();
  drawMap();
  cost_profile_.start();
  emit changed();
}

void AlignDesk::stepTo(bool (Alignment::*step)()) {
  if (work_ || !alignment_.isReady() || !(alignment_.*step)()) return;
  pause_timer_.stop();
  showPlace();
}

void AlignDesk::draw() {
  stale_ = false;
  const Pose& pose = alignment_.pose();
  const Residuals off = residualsOf(*alignment_.target(), alignment_.points(), pose);
  panel_->setResiduals(off);
  if (!pause_timer_.isActive()) panel_->setValues(valuesOf(pose), reach_);
  DrawnPath path;
  path.title = tr("distance [mm]").toStdString();
  path.show_through = true;
  path.min_span = kMinColorSpan;
  path.scale = colors_;
  if (colors_.range)
    path.scale.range = ValueRange{1e3 * colors_.range->low, 1e3 * colors_.range->high};
  const ScanAdvice* next = advice();
  const bool shows_deviation = next && !panel_->mapShown();
  if (shows_deviation) path.title = tr("deviation [mm]").toStdString();
  double longest = 0;
  const auto add = [&](const Vec3& at, double distance, const Vec3& foot) {
    path.samples.push_back({static_cast<double>(path.samples.size()), at, 1e3 * std::abs(distance),
                            false, false, foot});
    longest = std::max(longest, (at - foot).norm());
  };
  if (const std::optional<Registration>& found = alignment_.found()) {
    const auto valueAt = [&](const SurfaceResidual& residual) {
      if (!shows_deviation) return residual.distance;
      const auto face = static_cast<std::size_t>(residual.foot.face);
      float least = std::numeric_limits<float>::infinity();
      for (const std::int32_t corner : alignment_.target()->mesh().triangles[face])
        least = std::min(least, next->known.height_deviation[static_cast<std::size_t>(corner)]);
      return static_cast<double>(least);
    };
    for (std::size_t i = 0; i < found->residuals.size(); ++i)
      if (found->inliers[i])
        add(pose * alignment_.path()[i].position, valueAt(found->residuals[i]),
            found->residuals[i].at);
  } else {
    for (std::size_t i = 0; i < alignment_.points().size(); ++i)
      add(pose * alignment_.points()[i], off.distances[i], off.feet[i]);
  }
  const double room = kMaxLineShare * alignment_.target()->extent();
  const double stretch = longest > kNoLine ? std::max(1.0, roundLength(room / longest)) : 1;
  path.stretch = panel_->linesShown() ? stretch : 0;
  panel_->setStretch(path.stretch);
  panel_->setNext(next ? shownText(inWords(*next)) : QString());
  std::vector<DrawnMark> marks = picking_.marks();
  if (next && next->stroke && !picking_.on())
    for (const Vec3& p : next->stroke->points) marks.push_back({0, p});
  central_views_->draw(std::move(path), marks,
                       picking_.on() ? std::nullopt : std::optional(alignment_.centroid()));
}

void AlignDesk::setColors(const ColorScale& error) {
  if (error == colors_) return;
  colors_ = error;
  if (!alignment_.isReady()) return;
  draw();
  drawMap();
}

const ScanAdvice* AlignDesk::advice() const {
  const bool known =
      advice_ && alignment_.found() && advised_pose_.isApprox(alignment_.pose(), 1e-12);
  return known && panel_->nextShown() ? &*advice_ : nullptr;
}

// Errors and heights that are not known are nan, which is grey.
void AlignDesk::drawMap() {
  std::vector<float> shown;
  const ScanAdvice* next = advice();
  if (panel_->mapShown())
    for (const float error : cost_profile_.error()) shown.push_back(1e3F * error);
  else if (next)
    for (const float deviation : next->known.height_deviation)
      shown.push_back(std::isfinite(deviation) ? 1e3F * deviation : std::nanf(""));
  central_views_->setMeshValues(shown);
}

void AlignDesk::registerFromHere() {
  if (!alignment_.isReady() || work_) return;
  alignment_.commit();
  pause_timer_.stop();
  setPicking(false);
  const QString title = tr("Fitting the path");
  work_ = TaskProgress{title, title};
  panel_->setReady(true, true);
  emit changed();
  ScanRegistrationOptions options;
  if (alignment_.isLaidByHand()) options.guess = alignment_.pose();
  fit_job_.start([this, options, path = alignment_.whole(),
                  target = alignment_.target()](Progress& progress, const Background::Post& post) {
    const auto rest = [this] {
      work_.reset();
      panel_->setReady(alignment_.isReady(), false);
    };
    try {
      const RegisteredScans scans = registerScans(*target, {path}, options, progress);
      const std::optional<ScanAdvice> next = adviceIfAny(*target, scans);
      post(true, [this, rest, scans, next, found = scans.of(0)] {
        rest();
        move(found.mesh_from_path);
        advice_ = next;
        advised_pose_ = alignment_.pose();
        finishMove(found);
        for (const std::string& line : scans.warnings) emit notified({shownText(line), true});
        for (const std::string& line : scans.doubts)
          emit notified({tr("The mesh: %1").arg(shownText(line)), true});
        emit fitted(!isUnreliable(found));
      });
    } catch (const std::exception& error) {
      post(true, [this, rest, problem = shownText(error.what())] {
        rest();
        panel_->setFit(problem);
        emit changed();
        emit notified({problem, true});
        emit fitted(false);
      });
    }
  });
}

void AlignDesk::cancel() {
  if (!work_) return;
  fit_job_.discardResult();
  work_.reset();
  panel_->setReady(alignment_.isReady(), false);
  emit changed();
  emit fitted(false);
}

void AlignDesk::setPicking(bool on) {
  picking_.set(on && alignment_.isReady() && !work_);
  central_views_->setPicking(picking_.on());
  panel_->setPicking(picking_.words());
  if (alignment_.isReady()) draw();
}

void AlignDesk::pick(const Ray& sight, double reach) {
  if (!picking_.on()) return;
  picking_.pick(sight, reach);
  panel_->setPicking(picking_.words());
  draw();
  const std::optional<Pose> pose = picking_.pose();
  if (!pose) return;
  setPicking(false);
  move(*pose);
  finishMove();
}

// The path lies in front of the mesh, as it is drawn through it.
QString AlignDesk::probeWords(const Ray& sight, double reach) const {
  const auto words = [](const QString& what, const Vec3& at, const QString& value) {
    return QStringLiteral("%1 · %2, %3, %4 mm%5")
        .arg(what)
        .arg(shownAs(1e3 * at.x(), 3), 0, 'f', 3)
        .arg(shownAs(1e3 * at.y(), 3), 0, 'f', 3)
        .arg(shownAs(1e3 * at.z(), 3), 0, 'f', 3)
        .arg(value);
  };
  const auto residual = [](double metres) {
    return tr(" · residual %1 mm").arg(shownAs(1e3 * metres, 3), 0, 'f', 3);
  };
  double nearest = reach;
  std::optional<Vec3> sample;
  for (const Vec3& point : alignment_.points()) {
    const Vec3 away = alignment_.pose() * point - sight.origin;
    const double off = away.cross(sight.direction).norm();
    if (off >= nearest) continue;
    nearest = off;
    sample = alignment_.pose() * point;
  }
  const SurfaceTarget& target = *alignment_.target();
  if (sample) return words(tr("Path"), *sample, residual(target.residual(*sample).distance));
  const auto hit = target.tree().firstHit(sight.origin, sight.direction, INFINITY);
  if (!hit) return {};
  const Vec3 at = sight.origin + hit->t * sight.direction;
  const std::vector<float>& error = cost_profile_.error();
  if (error.empty()) return words(tr("Mesh"), at, {});
  double mean = 0;
  const Triangle& face = target.mesh().triangles[static_cast<std::size_t>(hit->surface.face)];
  for (std::size_t k = 0; k < 3; ++k)
    mean += hit->surface.barycentric[static_cast<Eigen::Index>(k)] *
            static_cast<double>(error[static_cast<std::size_t>(face[k])]);
  return words(tr("Mesh"), at, std::isfinite(mean) ? residual(mean) : tr(" · no samples near"));
}

void AlignDesk::refresh() {
  if (unseen_ && central_views_->isVisible()) {
    unseen_ = false;
    if (alignment_.path().empty()) files_.openFirstScan();
  }
  if (stale_) draw();
  central_views_->refresh();
}

} // namespace patina
