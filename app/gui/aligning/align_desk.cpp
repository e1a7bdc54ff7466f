#include "app/gui/aligning/align_desk.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "acquisition/registration/first_guess.h"
#include "app/gui/aligning/fit_words.h"
#include "visualization/layers/scale_layer.h"

namespace patina {
namespace {

constexpr std::size_t kFewest = 3; // samples that can be laid
constexpr double kFinest = 1e-3;   // of the colours' scale [mm]
constexpr int kSettle = 350;       // after its last change a value is a step [ms]
constexpr double kLongest = 0.06;  // of the mesh, that lines are stretched to
constexpr double kNoLine = 1e-9;   // [m]: shorter is rounding

} // namespace

AlignDesk::AlignDesk(QWidget& window)
    : QObject(&window), fit_job_(this), picking_(alignment_), around_(alignment_),
      files_(window, alignment_, *panel_) {
  settle_.setSingleShot(true);
  connect(&settle_, &QTimer::timeout, this, [this] { settle(); });
  connect(&files_, &AlignFiles::said, this, &AlignDesk::said);
  connect(&files_, &AlignFiles::opened, this,
          [this](const QString& name, const AlignedPath& path) { takePath(name, path, true); });
  connect(&files_, &AlignFiles::kept, this, [this](const Pose& pose) { kept_ = pose; });
  connect(panel_, &AlignPanel::storeAsked, this, [this] { files_.store(name_); });
  connect(cells_, &AlignCells::dragBegun, this, [this] { held_ = alignment_.pose(); });
  connect(cells_, &AlignCells::dragged, this, [this](const Pose& motion) { move(motion * held_); });
  connect(cells_, &AlignCells::dropped, this, [this] { settle(); });
  connect(cells_, &AlignCells::clicked, this, &AlignDesk::pick);
  connect(cells_, &AlignCells::escaped, this, [this] { setPicking(false); });
  connect(&around_, &AroundPlace::errorChanged, this, &AlignDesk::drawMap);
  connect(panel_, &AlignPanel::edited, this, [this](const PoseValues& values) {
    if (!alignment_.isReady() || work_) return;
    alignment_.setPose(poseOf(values));
    around_.forget();
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

std::map<Panel, QWidget*> AlignDesk::panels() const {
  return {{Panel::align, panel_}, {Panel::basin, around_.plot()}};
}

void AlignDesk::setPath(const QString& name, const AlignedPath& aligned) {
  std::vector<PathSample> path = inContact(aligned.path);
  if (path.size() < kFewest) {
    emit said({tr("%1 has fewer than three samples in contact").arg(name), true});
    return;
  }
  cancel();
  name_ = name;
  alignment_.setPath(std::move(path));
  begin();
  if (!aligned.mesh_from_path || !alignment_.isReady()) return;
  move(*aligned.mesh_from_path);
  settle();
  kept_ = alignment_.pose();
}

void AlignDesk::takePath(const QString& name, const AlignedPath& aligned, bool asks) {
  if (!asks) return setPath(name, aligned);
  const bool stands = offered_.has_value();
  offered_ = {name, aligned};
  if (stands) return; // the question is about this one from now on
  const bool replaces = inContact(aligned.path).size() >= kFewest;
  const bool goes_on = replaces && !settlePlacement();
  const auto [newest, path] = *std::exchange(offered_, std::nullopt);
  if (!goes_on) setPath(newest, path);
}

bool AlignDesk::isKept() const {
  return !alignment_.isReady() || alignment_.pose().isApprox(kept_, 1e-12);
}

bool AlignDesk::settlePlacement() {
  if (isKept()) return true;
  return files_.askKept(
      tr("Where %1 was laid onto the mesh is in no file and not in the workspace.").arg(name_));
}

void AlignDesk::setSceneMesh(std::shared_ptr<const TriangleMesh> mesh) {
  cancel();
  unseen_ = true;
  alignment_.setMesh(std::move(mesh));
  begin();
}

void AlignDesk::changeSceneMesh(std::shared_ptr<const TriangleMesh> mesh) {
  if (mesh == alignment_.mesh()) return; // a fit is still of it
  if (alignment_.steps().empty()) return setSceneMesh(std::move(mesh));
  cancel();
  alignment_.changeMesh(std::move(mesh));
  showAnew();
}

void AlignDesk::begin() {
  settle_.stop();
  kept_ = alignment_.pose();
  panel_->setPath(name_, alignment_.path().size());
  showAnew();
  if (alignment_.isReady()) cells_->fit();
}

void AlignDesk::showAnew() {
  setPicking(false);
  panel_->setReady(alignment_.isReady(), false);
  panel_->setFit({});
  if (alignment_.isReady()) {
    cells_->showMesh(std::make_shared<const TriangleMesh>(alignment_.target()->mesh()));
    reach_ =
        1.5 * alignment_.target()->extent() + alignment_.pose().translation().cwiseAbs().maxCoeff();
    draw();
    around_.look();
  } else {
    cells_->showMissing(!alignment_.path().empty());
  }
  emit changed();
}

void AlignDesk::move(const Pose& pose) {
  if (!alignment_.isReady() || work_) return;
  alignment_.setPose(pose);
  settle_.stop();
  around_.forget();
  draw();
}

void AlignDesk::settle(std::optional<Registration> fit) {
  if (!alignment_.isReady() || work_) return;
  settle_.stop();
  alignment_.commit(std::move(fit));
  showPlace();
}

void AlignDesk::showPlace() {
  const std::optional<Registration>& found = alignment_.found();
  panel_->setFit(found ? fitWords(*found) : QString());
  draw();
  around_.look();
  emit changed();
}

void AlignDesk::undo() {
  if (work_ || !alignment_.isReady() || !alignment_.undo()) return;
  settle_.stop();
  showPlace();
}

void AlignDesk::redo() {
  if (work_ || !alignment_.isReady() || !alignment_.redo()) return;
  settle_.stop();
  showPlace();
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
  if (const std::optional<Registration>& found = alignment_.found()) { // by its own numbers
    for (std::size_t i = 0; i < found->misses.size(); ++i)
      if (found->counts[i])
        add(pose * alignment_.path()[i].position, found->misses[i].distance, found->misses[i].at);
  } else {
    for (std::size_t i = 0; i < alignment_.points().size(); ++i)
      add(pose * alignment_.points()[i], off.distances[i], off.feet[i]);
  }
  const double room = kLongest * alignment_.target()->extent();
  const double stretch = longest > kNoLine ? std::max(1.0, roundLength(room / longest)) : 1;
  path.stretch = panel_->linesShown() ? stretch : 0;
  panel_->setStretch(path.stretch);
  cells_->draw(std::move(path), picking_.marks(),
               picking_.on() ? std::nullopt : std::optional(alignment_.middle()));
}

void AlignDesk::drawMap() {
  std::vector<float> shown;
  if (panel_->mapShown())
    for (const float error : around_.error()) shown.push_back(1e3F * error);
  cells_->setMeshValues(shown);
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
  ScanRegistrationOptions options;
  if (alignment_.isLaidByHand()) options.guess = alignment_.pose();
  fit_job_.start([this, options, path = alignment_.whole(), target = alignment_.target()](
                     Progress& progress, const Background::Deliver& deliver) {
    const auto rest = [this] {
      work_.reset();
      panel_->setReady(alignment_.isReady(), false);
    };
    try {
      const RegisteredScans scans = registerScans(*target, {path}, options, progress);
      deliver(true, [this, rest, scans, found = scans.of(0)] {
        rest();
        move(found.mesh_from_path);
        settle(found);
        for (const std::string& line : scans.warnings)
          emit said({QString::fromStdString(line), true});
        for (const std::string& line : scans.doubts)
          emit said({tr("The mesh: %1").arg(QString::fromStdString(line)), true});
        emit fitted(!isDoubtful(found));
      });
    } catch (const std::exception& error) {
      deliver(true, [this, rest, problem = QString::fromStdString(error.what())] {
        rest();
        panel_->setFit(problem);
        emit changed();
        emit said({problem, true});
        emit fitted(false);
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
  emit fitted(false);
}

void AlignDesk::setPicking(bool on) {
  picking_.set(on && alignment_.isReady() && !work_);
  cells_->setPicking(picking_.on());
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
  settle();
}

void AlignDesk::refresh() {
  if (unseen_ && cells_->isVisible()) {
    unseen_ = false;
    if (alignment_.path().empty()) files_.openFirstScan();
  }
  if (stale_) draw();
  cells_->refresh();
}

} // namespace patina
