#include "app/gui/aligning/align_central_views.h"

#include <algorithm>
#include <cmath>

#include <QShortcut>
#include <QVBoxLayout>

#include "acquisition/registration/error_map.h"
#include "acquisition/registration/rigid_fit.h"
#include "app/gui/toolkit/theme.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"
#include "visualization/values/palette.h"

namespace patina {
namespace {

constexpr double kSpread = 0.01; // Smallest distance between two points, as a fraction of the mesh.
constexpr double kMilli = 1e3;
const QColor kHere(0xe8, 0x79, 0x5c); // Marks the present pose on the map.
constexpr double kNothing = 1e-9;     // Smaller values are rounding [m].

QColor colorOf(double part) {
  const double at = std::clamp(part, 0., 1.) * (palette::kMuch.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), palette::kMuch.size() - 2);
  const double t = at - static_cast<double>(low);
  const auto mix = [&](std::size_t i) {
    return (1 - t) * palette::kMuch[low][i] + t * palette::kMuch[low + 1][i];
  };
  return QColor::fromRgbF(mix(0), mix(1), mix(2));
}

} // namespace

void PointPicking::set(bool on) {
  on_ = on;
  on_path_.clear();
  on_mesh_.clear();
}

void PointPicking::pick(const Ray& sight, double reach) {
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
}

QString PointPicking::words() const {
  if (!on_) return {};
  return (on_path_.size() == on_mesh_.size()
              ? QObject::tr("%1 of 3: click a point on the path (Esc cancels)")
              : QObject::tr("%1 of 3: click the same point on the mesh"))
      .arg(on_mesh_.size() + 1);
}

std::vector<DrawnMark> PointPicking::marks() const {
  std::vector<DrawnMark> marks;
  for (const Vec3& point : on_path_) marks.push_back({0, alignment_.pose() * point});
  for (const Vec3& point : on_mesh_) marks.push_back({0, point});
  return marks;
}

std::optional<Pose> PointPicking::pose() const {
  if (on_mesh_.size() < 3) return std::nullopt;
  return fitRigid(on_path_, on_mesh_);
}

CostProfileJob::CostProfileJob(const Alignment& alignment) : alignment_(alignment) {
  plot_->setObjectName(QStringLiteral("basin_plot"));
  panel_->setToolTip(
      tr("RMS distance if the path is moved or rotated from its present pose. A minimum marks the "
         "fitted pose; a flat curve marks a direction that the scan does not determine."));
  auto* line = layoutIn<QHBoxLayout>(panel_, 2);
  auto* column = layoutIn<QVBoxLayout>(map_card_, 2);
  applyStyleSheet(*panel_, QStringLiteral("QWidget { background: @card; }"
                                          "QLabel[quiet=\"true\"] { color: @quiet; }"));
  line->addWidget(plot_, 4);
  line->addWidget(map_card_, 1);
  column->addWidget(new QLabel(tr("rms over shifts x, y")));
  column->addWidget(map_, 1);
  column->addWidget(map_words_);
  map_card_->hide();
}

// Returns the rms distance at each step of the history.
PlotAxes CostProfileJob::stepAxes() const {
  PlotCurve curve{tr("rms"), "accent"};
  std::vector<Pose> steps = alignment_.steps();
  steps.resize(alignment_.done() + 1); // Drops the undone ones.
  for (const Pose& step : steps)
    curve.points << QPointF(curve.points.size(),
                            kMilli *
                                residualsOf(*alignment_.target(), alignment_.points(), step).rms);
  PlotAxes axes{tr("steps"), tr("mm"), {curve}};
  axes.counted = true;
  return axes;
}

void CostProfileJob::show(const CostProfile& profile) {
  constexpr const char* kSeriesColors[] = {"series_x", "series_y", "series_z"};
  PlotContent content;
  for (const bool turns : {false, true}) {
    PlotAxes axes{turns ? QStringLiteral("°") : tr("mm"), tr("mm")};
    const double reach = turns ? profile.turn * 180 / M_PI : kMilli * profile.shift;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::vector<double>& rms = profile.along[axis + (turns ? 3 : 0)];
      const QString words = axis > 0 ? QStringLiteral("%1")
                            : turns  ? tr("rms, rotation %1")
                                     : tr("rms, shift %1");
      PlotCurve curve{words.arg(QChar('x' + static_cast<int>(axis))), kSeriesColors[axis]};
      for (std::size_t i = 0; i < rms.size(); ++i)
        curve.points << QPointF(
            reach * (2. * static_cast<double>(i) / static_cast<double>(rms.size() - 1) - 1),
            kMilli * rms[i]);
      axes.curves.push_back(curve);
    }
    content.axes.push_back(axes);
  }
  if (alignment_.done() > 0) content.axes.push_back(stepAxes());
  plot_->setContent(content);

  const auto [lowest, highest] = std::minmax_element(profile.map.begin(), profile.map.end());
  const int side = profile.side;
  QImage map(side, side, QImage::Format_RGB32);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const double rms = profile.map[static_cast<std::size_t>(row * side + column)];
      map.setPixelColor(column, side - 1 - row,
                        colorOf((rms - *lowest) / std::max(1e-12, *highest - *lowest)));
    }
  const double middle = 0.5 * (side - 1);
  PictureMark here{QPolygonF() << QPointF(middle, middle), kHere, 1.5, PictureMark::Shape::crosses};
  map_->setContent({map, {here}, {}, false});
  const auto shown = [](double rms) { return rms < kNothing ? 0 : kMilli * rms; };
  map_words_->setText(tr("±%1 mm: %2 to %3 mm")
                          .arg(kMilli * profile.shift, 0, 'f', 0)
                          .arg(shown(*lowest), 0, 'g', 3)
                          .arg(shown(*highest), 0, 'g', 3));
  map_card_->show();
}

void CostProfileJob::reset() {
  job_.discardResult(); // This also discards a map that is still being computed.
  if (error_.empty()) return;
  error_.clear();
  emit errorChanged();
}

void CostProfileJob::start() {
  map_card_->hide();
  plot_->setContent({{}, false, false, {}, {}, tr("Computing …")});
  reset();
  job_.start([this, target = alignment_.target(), points = alignment_.points(),
              path = alignment_.path(), found = alignment_.found(),
              pose = alignment_.pose()](Progress& progress, const Background::Post& post) {
    try {
      const Registration at = found ? *found : registeredAt(*target, path, pose);
      post(false, [this, error = errorMapOf(target->mesh(), at, kErrorRadius * target->extent())] {
        error_ = error;
        emit errorChanged();
      });
      const CostProfile profile = costProfileAround(*target, points, pose, progress);
      post(true, [this, profile] { show(profile); });
    } catch (const Cancelled&) {
      post(true, [] {});
    }
  });
}

AlignView::AlignView(const char* name, ViewPreset from) : from_(from) {
  setParallel(camera(), true);
  setMinimumSize(160, 90);
  setObjectName(QString::fromUtf8(name));
  AlignView::fit();
}

void AlignView::fit() {
  look([this] { picture().setView(from_); });
}

void AlignView::setPicking(bool picks) {
  picks_ = picks;
  setCursor(picks ? Qt::CrossCursor : Qt::OpenHandCursor);
  leave();
}

std::optional<HandlePart> AlignView::under(const QPoint& pixel) {
  const auto view = picture().handle().view();
  if (!view || picks_) return std::nullopt;
  return partAt(*view, inPlane(pixel, view->middle));
}

void AlignView::press(const QMouseEvent& event) {
  held_ = event.button() == Qt::LeftButton ? under(event.pos()) : std::nullopt;
  if (!held_) return;
  drag_view_ = *picture().handle().view();
  drag_origin_ = inPlane(event.pos(), drag_view_.middle);
  emit dragStarted();
}

void AlignView::move(const QMouseEvent& event, double dx, double dy) {
  if (held_)
    return emit dragged(
        handleMotion(drag_view_, *held_, drag_origin_, inPlane(event.pos(), drag_view_.middle)));
  if (event.buttons() == Qt::NoButton) {
    picture().handle().setHighlighted(under(event.pos()));
    picture().setDirty();
    emit pointed(sightAt(event.pos()), reach());
  } else if (event.buttons().testFlag(Qt::RightButton)) {
    zoom(camera(), std::exp(3 * dy));
  } else if (!picks_ || event.buttons().testFlag(Qt::MiddleButton)) {
    pan(camera(), dx, dy);
  }
}

void AlignView::release(const QMouseEvent& event) {
  if (held_) {
    held_.reset();
    return emit dropped();
  }
  if (picks_ && event.button() == Qt::LeftButton && isClick(event))
    emit clicked(sightAt(event.pos()), reach());
}

void AlignView::leave() {
  picture().handle().setHighlighted(std::nullopt);
  picture().setDirty();
  emit pointed(std::nullopt, 0);
}

AlignCentralViews::AlignCentralViews() {
  addWidget(emptyPage(empty_, offer_));
  offer_->setObjectName(QStringLiteral("align_mesh"));
  connect(offer_, &QPushButton::clicked, this,
          [this] { emit meshRequested(shownText(offered_.string())); });
}

void AlignCentralViews::makeViews() {
  auto* page = new QWidget;
  auto* grid = layoutIn<QGridLayout>(page, 4);
  const std::tuple<const char*, QString, ViewPreset> kViews[] = {
      {"align_top", tr("Top"), ViewPreset::plus_z},
      {"align_bottom", tr("Bottom"), ViewPreset::minus_z},
      {"align_front", tr("Front"), ViewPreset::minus_y},
      {"align_back", tr("Back"), ViewPreset::plus_y}};
  for (const auto& [name, words, from] : kViews) {
    const int i = static_cast<int>(views_.size());
    auto* view = new AlignView(name, from);
    view->setToolTip(tr("Drag an arrow to shift the path along it, a ring to rotate it about its "
                        "axis, the ball to shift it freely. Drag elsewhere to shift the picture."));
    auto* cell = new QVBoxLayout;
    cell->setSpacing(1);
    auto* caption = new QLabel(words);
    caption->setContentsMargins(6, 0, 0, 0);
    cell->addWidget(caption);
    cell->addWidget(view, 1);
    grid->addLayout(cell, i / 2, i % 2);
    views_.push_back(view);
    connect(view, &AlignView::dragStarted, this, &AlignCentralViews::dragStarted);
    connect(view, &AlignView::dragged, this, &AlignCentralViews::dragged);
    connect(view, &AlignView::dropped, this, &AlignCentralViews::dropped);
    connect(view, &AlignView::clicked, this, &AlignCentralViews::clicked);
    connect(view, &AlignView::pointed, this, &AlignCentralViews::pointed);
  }
  for (int i = 0; i < 2; ++i) grid->setRowStretch(i, 1), grid->setColumnStretch(i, 1);
  addWidget(page);
  auto* escape = new QShortcut(Qt::Key_Escape, page);
  escape->setContext(Qt::WidgetWithChildrenShortcut);
  connect(escape, &QShortcut::activated, this, &AlignCentralViews::escaped);
}

void AlignCentralViews::offerMesh(const std::filesystem::path& file) {
  offered_ = file;
  offer_->setText(tr("Open the scan's %1").arg(shownText(file.filename().string())));
  offer_->setVisible(!offered_.empty() && has_path_);
}

void AlignCentralViews::showMissing(bool has_path) {
  has_path_ = has_path;
  empty_->setText(
      has_path ? tr("A path is open, but no mesh.\n\nOpen the mesh that was scanned: Ctrl + O.")
               : tr("Here you align the path of a scan with the mesh.\n\nOpen a scan on the desk "
                    "Scan, or a path.csv by Open path."));
  offerMesh(offered_);
  setCurrentIndex(0);
}

void AlignCentralViews::showMesh(const std::shared_ptr<const TriangleMesh>& mesh) {
  if (views_.empty()) makeViews();
  setCurrentIndex(1);
  for (AlignView* view : views_) view->picture().setMesh(mesh);
}

void AlignCentralViews::setPicking(bool picks) {
  for (AlignView* view : views_) view->setPicking(picks);
  if (picks) views_[0]->setFocus(); // Esc must reach the view.
}

void AlignCentralViews::draw(DrawnPath path, const std::vector<DrawnMark>& marks,
                             const std::optional<Vec3>& handle) {
  for (AlignView* view : views_) {
    path.bar = view == views_[1];
    view->picture().setPath(path);
    view->picture().setMarks(marks);
    view->picture().handle().setPlace(handle);
    view->picture().setDirty();
  }
}

} // namespace patina
