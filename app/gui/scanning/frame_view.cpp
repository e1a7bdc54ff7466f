#include "app/gui/scanning/frame_view.h"

#include <algorithm>
#include <iterator>

#include <QVBoxLayout>

#include "acquisition/tracking/lens.h"
#include "acquisition/values/orientation.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/theme.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

const QColor kFound(0x3d, 0xe0, 0xff), kLeftOut(0xff, 0x6b, 0x5e), kTip(0xff, 0xb0, 0x30);
constexpr double kAxis = 0.03; // Drawn length of the probe's axes [m].

QPointF pointOf(const Vec2& pixel) {
  return {pixel.x(), pixel.y()};
}

// Returns the camera turned like the picture. If it was calibrated for another size it is returned
// unchanged, because drawing on the picture needs no true scale.
std::optional<Camera> cameraOfPicture(const std::optional<Camera>& camera, const GreyFrame& image) {
  try {
    if (camera) return cameraOf(image, *camera, "");
  } catch (const FileError&) {
  }
  return camera;
}

// Draws the corners of a board in its order, which shows swapped corners.
void addBoardMarks(std::vector<PictureMark>& marks, const std::vector<Vec2>& corners) {
  QPolygonF points;
  for (const Vec2& corner : corners) points << pointOf(corner);
  marks.push_back({points, kTip, 0.8});
  marks.push_back({points, kFound, 1.4, PictureMark::Shape::crosses});
}

// Draws the probe's axes, and its tip as a ring. left_out: the path does not contain the pose.
void addProbeMarks(std::vector<PictureMark>& marks, const Pose& camera_from_probe,
                   const Camera& camera, const Vec3& tip, bool left_out) {
  const auto seen = [&](const Vec3& in_probe) -> std::optional<QPointF> {
    const Vec3 point = camera_from_probe * in_probe;
    if (point.z() < 0.01) return std::nullopt;
    return pointOf(pixelOf(camera, point));
  };
  const auto origin = seen(Vec3::Zero()), end = seen(tip);
  const QColor color = left_out ? kLeftOut : kTip;
  if (origin && end) marks.push_back({QPolygonF() << *origin << *end, color});
  const QColor axes[] = {{0xff, 0x7a, 0x6a}, {0x6e, 0xe0, 0x7c}, {0x84, 0xb4, 0xff}};
  for (int i = 0; i < 3; ++i)
    if (const auto tip_of_axis = seen(kAxis * Vec3::Unit(i)); origin && tip_of_axis)
      marks.push_back({QPolygonF() << *origin << *tip_of_axis, axes[i], 2.2,
                       PictureMark::Shape::line, QString(QChar('x' + i))});
  if (end) marks.push_back({QPolygonF() << *end, color, 2, PictureMark::Shape::ring});
}

} // namespace

QImage imageOf(const GreyFrame& frame) {
  if (frame.pixel.empty()) return {};
  return QImage(frame.pixel.data(), frame.width, frame.height, frame.width,
                QImage::Format_Grayscale8)
      .copy();
}

std::vector<PictureMark> markerMarks(const std::vector<SeenMarker>& markers) {
  std::vector<PictureMark> marks;
  for (const SeenMarker& marker : markers) {
    PictureMark& mark = marks.emplace_back(PictureMark{{}, kFound, 1.4});
    for (std::size_t k = 0; k <= 4; ++k) mark.points << pointOf(marker.corner[k % 4].pixel);
    mark.tag = QString::number(marker.id);
  }
  return marks;
}

FrameView::FrameView(OpenScan& scan, QWidget* parent)
    : QWidget(parent), scan_(scan), title_(new ElidedLabel(this)), canvas_(new PictureView(this)),
      why_(new QLabel(this)), job_(this) {
  auto* column = layoutIn<QVBoxLayout>(this, 0);
  for (QLabel* label : {static_cast<QLabel*>(title_), why_}) label->setMargin(4);
  canvas_->setFocusPolicy(Qt::StrongFocus);
  canvas_->setMinimumSize(200, 150);
  named(canvas_, "frame",
        tr("The camera's picture with the markers found, their ids, and the probe at its pose, the "
           "tip as a ring. The wheel zooms, a drag shifts, a double click shows all of it"));
  named(title_, "frame_title",
        tr("The frame, its time, the markers used for its pose, and their reprojection error"));
  named(why_, "frame_why")->setWordWrap(true);
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
    requested_.reset();
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
  if (requested_ == frame) refresh();
}

void FrameView::showLive(const RecordedFrame& frame) {
  const ScanFiles& files = *scan_.files();
  PictureContent content{imageOf(frame.image)};
  const std::optional<Camera> camera = cameraOfPicture(files.camera, frame.image);
  if (camera && frame.pose)
    addProbeMarks(content.marks, poseOf(*frame.pose), *camera, files.tip(), false);
  std::ranges::copy(markerMarks(frame.markers), std::back_inserter(content.marks));
  canvas_->setContent(content);
  title_->setText(tr("Live · %1 s").arg(frame.t, 0, 'f', 2));
  sayWhy(shownText(frame.why));
}

void FrameView::sayWhy(const QString& why) {
  why_->setText(why.isEmpty() ? tr("No problem here.") : why);
  applyStyleSheet(*why_, why.isEmpty() ? QStringLiteral("color: @quiet;")
                                       : QStringLiteral("color: @warn;"));
}

void FrameView::load() {
  if (scan_.grows()) return; // showLive() shows the frames.
  const ScanFiles* files = scan_.files();
  if (files == nullptr || files->frames.empty()) {
    picture_ = {};
    markers_.clear();
    fault_ = files != nullptr && !files->problem.empty()
                 ? shownText(files->problem)
                 : tr("This scan has no frames: its poses come from another program.");
    return refresh();
  }
  const std::size_t frame = scan_.cursor().frame();
  if (requested_ == frame) return describe();
  requested_ = frame;
  job_.start([this, path = files->frames[frame].file, camera = files->camera,
              rig = files->markers](Progress&, const Background::Post& post) {
    QString fault;
    QImage picture;
    std::vector<PictureMark> markers;
    std::optional<Camera> shown = camera;
    try {
      const GreyFrame image = readGrey(path);
      picture = imageOf(image);
      shown = cameraOfPicture(camera, image);
      if (shown && !rig.empty()) {
        RigTracker tracker(*shown, rig);
        tracker.track(image, 0);
        markers = markerMarks(tracker.markers());
      }
    } catch (const std::exception& error) {
      fault = shownText(error.what());
    }
    post(true, [this, picture, shown, markers, fault] {
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
  PictureContent content{picture_, {}, fault_};
  const ScanPath* path = scan_.path();
  if (path != nullptr && requested_ && camera_)
    if (const auto pose = poseAt(path->poses, files->frames[*requested_].t)) {
      const auto& verdicts = path->filtered.track.verdicts;
      addProbeMarks(content.marks, poseOf(path->poses[*pose]), *camera_, files->tip(),
                    *pose < verdicts.size() && verdicts[*pose] != PoseVerdict::used);
    }
  std::ranges::copy(markers_, std::back_inserter(content.marks));
  if (requested_ && boards_.contains(*requested_))
    addBoardMarks(content.marks, boards_.at(*requested_));
  canvas_->setContent(content);
  describe();
}

void FrameView::describe() {
  const ScanFiles* files = scan_.files();
  if (files == nullptr || scan_.grows()) return;
  QString title = QStringLiteral("%1 s").arg(scan_.cursor().time(), 0, 'f', 3), why;
  if (requested_) {
    const SeenFrame& seen = scan_.seen()[*requested_];
    title = tr("Frame %1 of 0 to %2 · %3 s")
                .arg(*requested_)
                .arg(files->frames.size() - 1)
                .arg(files->frames[*requested_].t, 0, 'f', 3);
    if (seen.looked && seen.why.empty()) {
      title += seen.markers == 1 ? tr(" · 1 marker") : tr(" · %1 markers").arg(seen.markers);
      title += tr(" · %1 px").arg(seen.rms, 0, 'f', 2);
    }
    why = seen.looked ? shownText(seen.why) : QString();
  }
  if (const Finding* finding = scan_.cursor().finding()) why = finding->words;
  title_->setText(title);
  sayWhy(why);
}

} // namespace patina
