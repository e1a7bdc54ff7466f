#include "app/gui/scanning/frame_view.h"

#include <cmath>

#include <QMouseEvent>
#include <QPainter>
#include <QVBoxLayout>
#include <QWheelEvent>

#include "acquisition/orientation.h"
#include "acquisition/tracking/lens.h"
#include "acquisition/tracking/track_frames.h"
#include "app/gui/window/theme.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

// Over any grey: bright on a dark seam.
const QColor kFound(0x3d, 0xe0, 0xff), kLeftOut(0xff, 0x6b, 0x5e), kTip(0xff, 0xb0, 0x30),
    kSeam(0, 0, 0, 170);
constexpr double kAxis = 0.03; // drawn length of the probe's axes [m]

void drawSeamed(QPainter& painter, const QColor& color, double width, const QPolygonF& line) {
  for (const auto& [ink, wide] : {std::pair(kSeam, width + 2), {color, width}}) {
    painter.setPen(QPen(ink, wide, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    painter.drawPolyline(line);
  }
}

void drawTag(QPainter& painter, const QColor& color, const QPointF& at, const QString& words) {
  QFont bold = painter.font();
  bold.setBold(true);
  painter.setFont(bold);
  const QRectF room = QFontMetricsF(bold).boundingRect(words).adjusted(-3, -1, 3, 1);
  painter.fillRect(room.translated(at), kSeam);
  painter.setPen(color);
  painter.drawText(at, words);
}

// Returns the camera turned as the picture is, or as it was given where it was calibrated for
// pictures of another size: drawing over them needs no right scale.
std::optional<Camera> cameraOfPicture(const std::optional<Camera>& camera, const GreyFrame& image) {
  try {
    if (camera) return cameraOf(image, *camera, "");
  } catch (const FileError&) {
  }
  return camera;
}

} // namespace

QImage imageOf(const GreyFrame& frame) {
  if (frame.pixel.empty()) return {};
  return QImage(frame.pixel.data(), frame.width, frame.height, frame.width,
                QImage::Format_Grayscale8)
      .copy();
}

std::vector<FrameMarks::Outline> outlinesOf(const std::vector<SeenMarker>& markers) {
  std::vector<FrameMarks::Outline> outlines;
  for (const SeenMarker& marker : markers) {
    FrameMarks::Outline& outline = outlines.emplace_back();
    outline.id = marker.id;
    for (std::size_t k = 0; k < 4; ++k) outline.corner[k] = marker.corner[k].pixel;
  }
  return outlines;
}

FrameCanvas::FrameCanvas(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("frame"));
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setFocusPolicy(Qt::StrongFocus);
  setToolTip(tr("What the camera saw: the markers that were found, with their ids, and the probe "
                "as its pose has it, its tip as a ring. The wheel zooms, a drag shifts, a double "
                "click shows all of it"));
}

void FrameCanvas::show(const QImage& picture, const FrameMarks& marks,
                       const std::optional<Camera>& camera, const Vec3& tip, const QString& words) {
  picture_ = picture;
  marks_ = marks;
  camera_ = camera;
  tip_ = tip;
  words_ = words;
  update();
}

double FrameCanvas::scale() const {
  return zoom_ * std::min(static_cast<double>(width()) / picture_.width(),
                          static_cast<double>(height()) / picture_.height());
}

QPointF FrameCanvas::placeOf(const Vec2& pixel) const {
  return {0.5 * width() + shift_.x() + scale() * (pixel.x() + 0.5 - 0.5 * picture_.width()),
          0.5 * height() + shift_.y() + scale() * (pixel.y() + 0.5 - 0.5 * picture_.height())};
}

void FrameCanvas::wheelEvent(QWheelEvent* event) {
  const double before = zoom_;
  zoom_ = std::clamp(zoom_ * std::pow(1.25, event->angleDelta().y() / 120.), 1., 40.);
  // What is under the pointer stays there.
  const QPointF at = event->position() - QPointF(0.5 * width(), 0.5 * height());
  shift_ = zoom_ == 1 ? QPointF() : at + (shift_ - at) * (zoom_ / before);
  update();
}

void FrameCanvas::mousePressEvent(QMouseEvent* event) {
  last_ = event->localPos();
}

void FrameCanvas::mouseMoveEvent(QMouseEvent* event) {
  if (zoom_ > 1) shift_ += event->localPos() - last_;
  last_ = event->localPos();
  update();
}

void FrameCanvas::mouseDoubleClickEvent(QMouseEvent*) {
  zoom_ = 1;
  shift_ = {};
  update();
}

void FrameCanvas::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), ink("soft"));
  if (picture_.isNull()) {
    painter.setPen(ink("quiet"));
    painter.drawText(rect().adjusted(12, 12, -12, -12), Qt::AlignCenter | Qt::TextWordWrap, words_);
    return;
  }
  painter.setRenderHints(QPainter::SmoothPixmapTransform | QPainter::Antialiasing);
  painter.drawImage(
      QRectF(placeOf({-0.5, -0.5}), placeOf({picture_.width() - 0.5, picture_.height() - 0.5})),
      picture_);
  if (camera_ && marks_.camera_from_probe) drawProbe(painter);
  drawMarkers(painter);
  drawBoard(painter);
}

void FrameCanvas::drawBoard(QPainter& painter) const {
  QPolygonF way; // in the board's order, which shows a corner that was mistaken for another
  for (const Vec2& corner : marks_.corners) way << placeOf(corner);
  if (way.size() > 1) drawSeamed(painter, kTip, 0.8, way);
  for (const QPointF& at : way) {
    drawSeamed(painter, kFound, 1.4, QPolygonF() << at - QPointF(4, 0) << at + QPointF(4, 0));
    drawSeamed(painter, kFound, 1.4, QPolygonF() << at - QPointF(0, 4) << at + QPointF(0, 4));
  }
}

void FrameCanvas::drawMarkers(QPainter& painter) const {
  for (const FrameMarks::Outline& marker : marks_.markers) {
    QPolygonF line;
    for (std::size_t k = 0; k <= 4; ++k) line << placeOf(marker.corner[k % 4]);
    drawSeamed(painter, kFound, 1.4, line);
    // Beside the marker, which is what one wants to see.
    const QString id = QString::number(marker.id);
    const QRectF room = line.boundingRect();
    drawTag(painter, kFound,
            {room.left() - 10 - painter.fontMetrics().horizontalAdvance(id), room.center().y() + 4},
            id);
  }
}

void FrameCanvas::drawProbe(QPainter& painter) const {
  const Pose& pose = *marks_.camera_from_probe;
  const auto seen = [&](const Vec3& in_probe) -> std::optional<QPointF> {
    const Vec3 point = pose * in_probe;
    if (point.z() < 0.01) return std::nullopt;
    return placeOf(pixelOf(*camera_, point));
  };
  const auto origin = seen(Vec3::Zero()), tip = seen(tip_);
  const QColor color = marks_.left_out ? kLeftOut : kTip;
  if (origin && tip) drawSeamed(painter, color, 1.6, QPolygonF() << *origin << *tip);
  const QColor axes[] = {{0xff, 0x7a, 0x6a}, {0x6e, 0xe0, 0x7c}, {0x84, 0xb4, 0xff}};
  for (int i = 0; i < 3; ++i) {
    const auto end = seen(kAxis * Vec3::Unit(i));
    if (!origin || !end) continue;
    drawSeamed(painter, axes[i], 2.2, QPolygonF() << *origin << *end);
    drawTag(painter, axes[i], *end + QPointF(3, -3), QString(QChar('x' + i)));
  }
  if (!tip) return;
  painter.setBrush(Qt::NoBrush);
  for (const auto& [ink, wide] : {std::pair(kSeam, 4.), {color, 2.}}) {
    painter.setPen(QPen(ink, wide));
    painter.drawEllipse(*tip, 5, 5);
  }
}

FrameView::FrameView(OpenScan& scan, QWidget* parent)
    : QWidget(parent), scan_(scan), title_(new ElidedLabel(this)), canvas_(new FrameCanvas(this)),
      why_(new QLabel(this)), job_(this) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  for (QLabel* label : {static_cast<QLabel*>(title_), why_}) label->setMargin(4);
  title_->setObjectName(QStringLiteral("frame_title"));
  title_->setToolTip(tr("The frame, its time, the markers that its pose follows from, and by how "
                        "much their corners miss it"));
  why_->setObjectName(QStringLiteral("frame_why"));
  why_->setWordWrap(true);
  why_->setTextFormat(Qt::PlainText);
  why_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  why_->setMinimumHeight(3 * fontMetrics().lineSpacing() + 8);
  why_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  why_->setFocusPolicy(Qt::NoFocus);
  column->addWidget(title_);
  column->addWidget(canvas_, 1);
  column->addWidget(why_);
  setMinimumWidth(220);
  connect(&scan_, &OpenScan::opened, this, [this] {
    asked_.reset();
    boards_.clear();
    load();
  });
  connect(&scan_.cursor(), &ScanCursor::moved, this, &FrameView::load);
  connect(&scan_, &OpenScan::framesSeen, this, &FrameView::describe);
  connect(&scan_, &OpenScan::pathMade, this, &FrameView::refresh);
  load();
}

void FrameView::addBoard(std::size_t frame, const BoardView& view) {
  boards_[frame] = view.pixel;
  if (asked_ == frame) refresh();
}

void FrameView::showLive(const RecordedFrame& frame) {
  const ScanFiles& files = *scan_.files();
  FrameMarks marks;
  marks.markers = outlinesOf(frame.markers);
  if (frame.pose) marks.camera_from_probe = poseOf(*frame.pose);
  canvas_->show(imageOf(frame.image), marks, cameraOfPicture(files.camera, frame.image),
                files.tip());
  title_->setText(tr("Live · %1 s").arg(frame.t, 0, 'f', 2));
  sayWhy(QString::fromStdString(frame.why));
}

void FrameView::sayWhy(const QString& why) {
  why_->setText(why.isEmpty() ? tr("Nothing is missing here.") : why);
  dress(*why_, why.isEmpty() ? QStringLiteral("color: @quiet;") : QStringLiteral("color: @warn;"));
}

void FrameView::load() {
  if (scan_.grows()) return; // showLive() does
  const ScanFiles* files = scan_.files();
  if (files == nullptr || files->frames.empty()) {
    picture_ = {};
    markers_.clear();
    fault_ = files != nullptr && !files->problem.empty()
                 ? QString::fromStdString(files->problem)
                 : tr("This scan has no frames: its poses come from another program.");
    return refresh();
  }
  const std::size_t frame = scan_.cursor().frame();
  if (asked_ == frame) return describe();
  asked_ = frame;
  job_.start([this, path = files->frames[frame].file, camera = files->camera,
              rig = files->markers](Progress&, const Background::Deliver& deliver) {
    QString fault;
    QImage picture;
    std::vector<FrameMarks::Outline> markers;
    std::optional<Camera> shown = camera;
    try {
      const GreyFrame image = readGrey(path);
      picture = imageOf(image);
      shown = cameraOfPicture(camera, image);
      if (shown && !rig.empty()) {
        RigTracker tracker(*shown, rig);
        tracker.track(image, 0);
        markers = outlinesOf(tracker.markers());
      }
    } catch (const std::exception& error) {
      fault = QString::fromStdString(error.what());
    }
    deliver(true, [this, picture, shown, markers, fault] {
      picture_ = picture;
      camera_ = shown;
      markers_ = markers;
      fault_ = fault;
      refresh();
    });
  });
  describe();
}

void FrameView::refresh() {
  const ScanFiles* files = scan_.files();
  if (files == nullptr || scan_.grows()) return;
  FrameMarks marks;
  marks.markers = markers_;
  const ScanPath* path = scan_.path();
  if (asked_ && boards_.contains(*asked_)) marks.corners = boards_.at(*asked_);
  if (path != nullptr && asked_) {
    const auto pose = poseAt(path->poses, files->frames[*asked_].t);
    const auto& verdicts = path->filtered.track.verdicts;
    if (pose) marks.camera_from_probe = poseOf(path->poses[*pose]);
    marks.left_out = pose && *pose < verdicts.size() && verdicts[*pose] != PoseVerdict::used;
  }
  canvas_->show(picture_, marks, camera_, files->tip(), fault_);
  describe();
}

void FrameView::describe() {
  const ScanFiles* files = scan_.files();
  if (files == nullptr || scan_.grows()) return;
  QString title = QStringLiteral("%1 s").arg(scan_.cursor().time(), 0, 'f', 3), why;
  if (asked_) {
    const SeenFrame& seen = scan_.seen()[*asked_];
    title = tr("Frame %1 of 0 to %2 · %3 s")
                .arg(*asked_)
                .arg(files->frames.size() - 1)
                .arg(files->frames[*asked_].t, 0, 'f', 3);
    if (seen.looked && seen.why.empty()) {
      title += seen.markers == 1 ? tr(" · 1 marker") : tr(" · %1 markers").arg(seen.markers);
      title += tr(" · %1 px").arg(seen.rms, 0, 'f', 2);
    }
    why = seen.looked ? QString::fromStdString(seen.why) : QString();
  }
  if (const Finding* finding = scan_.cursor().finding()) why = finding->words;
  title_->setText(title);
  sayWhy(why);
}

} // namespace patina
