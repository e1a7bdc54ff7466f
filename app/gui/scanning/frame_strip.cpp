#include "app/gui/scanning/frame_strip.h"

#include <QHelpEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QScrollBar>
#include <QToolTip>
#include <QWheelEvent>

#include "app/gui/scanning/frame_view.h"
#include "app/gui/window/theme.h"

namespace patina {
namespace {

constexpr int kThumbWide = 72, kThumbHigh = 54, kCell = 78, kBadgeLine = 17, kEdge = 3;

} // namespace

void drawBadge(QPainter& painter, const QPointF& middle, FrameQuality quality) {
  painter.save();
  painter.translate(middle);
  painter.setRenderHint(QPainter::Antialiasing);
  const auto pen = [&](const char* name) {
    painter.setPen(QPen(ink(name), 1.8, Qt::SolidLine, Qt::RoundCap));
    painter.setBrush(Qt::NoBrush);
  };
  switch (quality) {
  case FrameQuality::good:
    painter.setPen(Qt::NoPen);
    painter.setBrush(ink("series_y"));
    painter.drawEllipse(QPointF(0, 0), 4, 4);
    break;
  case FrameQuality::few:
    pen("series_y");
    painter.drawEllipse(QPointF(0, 0), 3.6, 3.6);
    break;
  case FrameQuality::ambiguous:
    pen("warn");
    painter.drawPolyline(QPolygonF() << QPointF(-4, 3.5) << QPointF(0, -4) << QPointF(4, 3.5)
                                     << QPointF(-4, 3.5));
    break;
  case FrameQuality::rejected:
    pen("bad");
    painter.drawLine(QPointF(-3.5, -3.5), QPointF(3.5, 3.5));
    painter.drawLine(QPointF(-3.5, 3.5), QPointF(3.5, -3.5));
    break;
  case FrameQuality::no_marker:
    pen("quiet");
    painter.drawLine(QPointF(-4, 0), QPointF(4, 0));
    break;
  case FrameQuality::unreadable:
    pen("bad");
    painter.drawRect(QRectF(-4, -4, 8, 8));
    painter.drawLine(QPointF(-4, 4), QPointF(4, -4));
    break;
  case FrameQuality::unknown:
    painter.setPen(Qt::NoPen);
    painter.setBrush(ink("grip"));
    painter.drawEllipse(QPointF(0, 0), 1.8, 1.8);
    break;
  }
  painter.restore();
}

QString wordOf(FrameQuality quality) {
  const char* words[] = {"good",      "one marker only", "ambiguous",        "rejected",
                         "no marker", "unreadable",      "not looked at yet"};
  return FrameStrip::tr(words[static_cast<std::size_t>(quality)]);
}

FrameStrip::FrameStrip(OpenScan& scan, QWidget* parent)
    : QAbstractScrollArea(parent), scan_(scan), job_(this) {
  setObjectName(QStringLiteral("strip"));
  setFrameShape(QFrame::NoFrame);
  setFocusPolicy(Qt::StrongFocus);
  setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOn);
  setToolTip(tr("The frames, and what each is worth; a click goes there, as the arrow keys do"));
  setFixedHeight(minimumSizeHint().height());
  connect(&scan_, &OpenScan::opened, this, &FrameStrip::takeScan);
  connect(&scan_.cursor(), &ScanCursor::moved, this, &FrameStrip::showCursor);
  const auto redraw = [this] { viewport()->update(); };
  connect(&scan_, &OpenScan::framesSeen, this, redraw);
  connect(&scan_, &OpenScan::pathMade, this, redraw);
  connect(horizontalScrollBar(), &QScrollBar::valueChanged, this, &FrameStrip::load);
  takeScan();
}

QSize FrameStrip::minimumSizeHint() const {
  return {2 * kCell,
          kThumbHigh + kBadgeLine + 2 * kEdge + horizontalScrollBar()->sizeHint().height()};
}

std::size_t FrameStrip::count() const {
  return scan_.files() != nullptr ? scan_.files()->frames.size() : 0;
}

QRect FrameStrip::placeOf(std::size_t frame) const {
  return {static_cast<int>(frame) * kCell - horizontalScrollBar()->value(), 0, kCell,
          viewport()->height()};
}

std::optional<std::size_t> FrameStrip::frameAt(const QPoint& place) const {
  const int frame = (place.x() + horizontalScrollBar()->value()) / kCell;
  if (frame < 0 || frame >= static_cast<int>(count())) return std::nullopt;
  return static_cast<std::size_t>(frame);
}

std::pair<std::size_t, std::size_t> FrameStrip::seen() const {
  const int from = horizontalScrollBar()->value();
  const auto first = static_cast<std::size_t>(from / kCell);
  const auto behind = static_cast<std::size_t>((from + viewport()->width()) / kCell + 1);
  return {std::min(first, count()), std::min(behind, count())};
}

void FrameStrip::takeScan() {
  job_.silence();
  thumbs_.clear();
  setVisible(count() > 0);
  arrange();
  horizontalScrollBar()->setValue(0);
  load();
}

void FrameStrip::arrange() {
  const int all = static_cast<int>(count()) * kCell;
  horizontalScrollBar()->setRange(0, std::max(0, all - viewport()->width()));
  horizontalScrollBar()->setPageStep(viewport()->width());
  horizontalScrollBar()->setSingleStep(kCell);
}

void FrameStrip::resizeEvent(QResizeEvent*) {
  arrange();
  load();
}

void FrameStrip::showCursor() {
  if (count() == 0) return;
  const QRect place = placeOf(scan_.cursor().frame());
  if (!viewport()->rect().contains(place))
    horizontalScrollBar()->setValue(horizontalScrollBar()->value() + place.center().x() -
                                    viewport()->width() / 2);
  viewport()->update();
}

void FrameStrip::load() {
  viewport()->update();
  const auto [first, behind] = seen();
  std::erase_if(thumbs_, [&, from = first, to = behind](const auto& thumb) {
    return thumb.first + (to - from) < from || thumb.first > to + (to - from);
  });
  std::vector<std::pair<std::size_t, std::filesystem::path>> wanted;
  for (std::size_t i = first; i < behind; ++i)
    if (!thumbs_.contains(i)) wanted.emplace_back(i, scan_.files()->frames[i].file);
  if (wanted.empty()) return;
  job_.start([this, wanted](Progress& progress, const Background::Deliver& deliver) {
    for (const auto& [frame, path] : wanted) {
      if (progress.cancelled()) break;
      QImage thumb;
      try {
        thumb = imageOf(readGrey(path))
                    .scaled(2 * kThumbWide, 2 * kThumbHigh, Qt::KeepAspectRatio,
                            Qt::SmoothTransformation);
      } catch (const std::exception&) { // it stands as one that cannot be read
      }
      deliver(false, [this, frame = frame, thumb] {
        thumbs_[frame] = thumb;
        viewport()->update();
      });
    }
    deliver(true, [] {});
  });
}

void FrameStrip::paintEvent(QPaintEvent*) {
  QPainter painter(viewport());
  painter.fillRect(viewport()->rect(), ink("card"));
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  if (count() == 0) return;
  const std::size_t now = scan_.cursor().frame();
  const auto [first, behind] = seen();
  for (std::size_t i = first; i < behind; ++i) {
    const QRect cell = placeOf(i);
    const QRect room(cell.left() + kEdge, kEdge, kThumbWide, kThumbHigh);
    if (i == now) painter.fillRect(cell, ink("chosen"));
    painter.fillRect(room, ink("soft"));
    const auto thumb = thumbs_.find(i);
    if (thumb != thumbs_.end() && !thumb->second.isNull()) {
      const QSize size = thumb->second.size().scaled(room.size(), Qt::KeepAspectRatio);
      painter.drawImage(QRect(room.center() - QPoint(size.width() / 2, size.height() / 2), size),
                        thumb->second);
    }
    if (i == now) {
      painter.setPen(QPen(ink("accent"), 2));
      painter.drawRect(room);
    }
    const int line = kEdge + kThumbHigh + kBadgeLine / 2 + 1;
    drawBadge(painter, QPointF(cell.left() + 10, line), scan_.qualityOf(i));
    painter.setPen(ink("text"));
    painter.drawText(QRect(cell.left() + 18, line - kBadgeLine / 2, kCell - 22, kBadgeLine),
                     Qt::AlignRight | Qt::AlignVCenter,
                     QStringLiteral("%1 s").arg(scan_.files()->frames[i].t, 0, 'f', 2));
  }
}

void FrameStrip::mousePressEvent(QMouseEvent* event) {
  if (const auto frame = frameAt(event->pos())) scan_.cursor().set(scan_.files()->frames[*frame].t);
}

void FrameStrip::wheelEvent(QWheelEvent* event) {
  const int notch =
      event->angleDelta().y() != 0 ? event->angleDelta().y() : event->angleDelta().x();
  horizontalScrollBar()->setValue(horizontalScrollBar()->value() - notch * kCell / 60);
}

bool FrameStrip::viewportEvent(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QAbstractScrollArea::viewportEvent(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  const auto frame = frameAt(help->pos());
  QToolTip::showText(help->globalPos(),
                     frame ? tr("Frame %1: %2").arg(*frame).arg(wordOf(scan_.qualityOf(*frame)))
                           : toolTip());
  return true;
}

} // namespace patina
