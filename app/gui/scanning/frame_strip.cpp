#include "app/gui/scanning/frame_strip.h"

#include <algorithm>

#include <QPainter>
#include <QScrollBar>
#include <QSignalBlocker>
#include <QStyledItemDelegate>

#include "app/gui/scanning/frame_view.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/theme.h"

namespace patina {
namespace {

constexpr int kThumbWide = 72, kThumbHigh = 54, kCell = 78, kBadgeLine = 17, kEdge = 3;
constexpr int kCellHigh = kThumbHigh + kBadgeLine + 2 * kEdge;

// Differs in form as well as in colour.
void drawBadge(QPainter& painter, const QPointF& middle, FrameQuality quality) {
  painter.save();
  painter.translate(middle);
  painter.setRenderHint(QPainter::Antialiasing);
  const auto pen = [&](const char* name) {
    painter.setPen(QPen(themeColor(name), 1.8, Qt::SolidLine, Qt::RoundCap));
    painter.setBrush(Qt::NoBrush);
  };
  switch (quality) {
  case FrameQuality::good:
    painter.setPen(Qt::NoPen);
    painter.setBrush(themeColor("series_y"));
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
    painter.setBrush(themeColor("grip"));
    painter.drawEllipse(QPointF(0, 0), 1.8, 1.8);
    break;
  }
  painter.restore();
}

class FrameItem : public QListWidgetItem {
 public:
  FrameItem(const OpenScan& scan, std::size_t frame, QListWidget* list)
      : QListWidgetItem(list), scan_(scan), frame_(frame) {}
  QVariant data(int role) const override {
    constexpr const char* kWords[] = {
        "good",      "one marker only", "ambiguous",        "rejected",
        "no marker", "unreadable",      "not looked at yet"};
    if (role == Qt::SizeHintRole) return QSize(kCell, kCellHigh);
    if (role != Qt::ToolTipRole && role != Qt::AccessibleTextRole) return {};
    return FrameStrip::tr("Frame %1: %2")
        .arg(frame_)
        .arg(FrameStrip::tr(kWords[static_cast<std::size_t>(scan_.qualityOf(frame_))]));
  }

 private:
  const OpenScan& scan_;
  std::size_t frame_;
};

class FrameDelegate : public QStyledItemDelegate {
 public:
  explicit FrameDelegate(FrameStrip& strip) : QStyledItemDelegate(&strip), strip_(strip) {}
  void paint(QPainter* painter, const QStyleOptionViewItem& option,
             const QModelIndex& index) const override {
    strip_.paintFrame(*painter, option.rect, static_cast<std::size_t>(index.row()));
  }

 private:
  const FrameStrip& strip_;
};

} // namespace

FrameStrip::FrameStrip(OpenScan& scan, QWidget* parent)
    : QListWidget(parent), scan_(scan), job_(this) {
  named(this, "strip",
        tr("Frames and their tracking quality. Click a frame or use the arrow keys to select it."));
  setFrameShape(QFrame::NoFrame);
  setFlow(QListView::LeftToRight);
  setUniformItemSizes(true);
  setHorizontalScrollMode(QAbstractItemView::ScrollPerPixel);
  setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOn);
  setAutoScroll(false); // showCursor() scrolls.
  setItemDelegate(new FrameDelegate(*this));
  setFixedHeight(minimumSizeHint().height());
  connect(&scan_, &OpenScan::opened, this, &FrameStrip::takeScan);
  connect(&scan_.cursor(), &ScanCursor::moved, this, &FrameStrip::showCursor);
  const auto redraw = [this] { viewport()->update(); };
  connect(&scan_, &OpenScan::framesSeen, this, redraw);
  connect(&scan_, &OpenScan::pathMade, this, redraw);
  connect(horizontalScrollBar(), &QScrollBar::valueChanged, this, &FrameStrip::load);
  connect(this, &QListWidget::currentRowChanged, this, [this](int row) {
    if (row >= 0) scan_.cursor().set(scan_.files()->frames[static_cast<std::size_t>(row)].t);
  });
  takeScan();
}

QSize FrameStrip::minimumSizeHint() const {
  return {2 * kCell, kCellHigh + horizontalScrollBar()->sizeHint().height()};
}

void FrameStrip::resizeEvent(QResizeEvent* event) {
  QListWidget::resizeEvent(event);
  load();
}

void FrameStrip::takeScan() {
  job_.discardResult();
  thumbs_.clear();
  const QSignalBlocker quiet(this);
  clear();
  const std::size_t frames = scan_.files() != nullptr ? scan_.files()->frames.size() : 0;
  for (std::size_t i = 0; i < frames; ++i) new FrameItem(scan_, i, this);
  setVisible(frames > 0);
  horizontalScrollBar()->setValue(0);
  showCursor();
  load();
}

void FrameStrip::showCursor() {
  if (count() == 0) return;
  const QSignalBlocker quiet(this);
  const std::size_t now = scan_.cursor().frame();
  setCurrentRow(static_cast<int>(now));
  if (!viewport()->rect().contains(placeOf(now)))
    scrollToItem(currentItem(), QAbstractItemView::PositionAtCenter);
  viewport()->update();
}

void FrameStrip::load() {
  viewport()->update();
  const int from = horizontalScrollBar()->value(), wide = viewport()->width();
  const auto frames = static_cast<std::size_t>(count());
  const auto first = std::min(frames, static_cast<std::size_t>(from / kCell));
  const auto behind = std::min(frames, static_cast<std::size_t>((from + wide) / kCell + 1));
  std::erase_if(thumbs_, [&, n = behind - first](const auto& thumb) {
    return thumb.first + n < first || thumb.first > behind + n;
  });
  std::vector<std::pair<std::size_t, std::filesystem::path>> wanted;
  for (std::size_t i = first; i < behind; ++i)
    if (!thumbs_.contains(i)) wanted.emplace_back(i, scan_.files()->frames[i].file);
  if (wanted.empty()) return;
  job_.start([this, wanted](Progress& progress, const Background::Post& post) {
    for (const auto& [frame, path] : wanted) {
      if (progress.cancelled()) break;
      QImage thumb;
      try {
        thumb = imageOf(readGrey(path))
                    .scaled(2 * kThumbWide, 2 * kThumbHigh, Qt::KeepAspectRatio,
                            Qt::SmoothTransformation);
      } catch (const std::exception&) { // Shown as unreadable.
      }
      post(false, [this, frame = frame, thumb] {
        thumbs_[frame] = thumb;
        viewport()->update();
      });
    }
    post(true, [] {});
  });
}

void FrameStrip::paintFrame(QPainter& painter, const QRect& cell, std::size_t frame) const {
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  const bool chosen = static_cast<int>(frame) == currentRow();
  const QRect room(cell.left() + kEdge, kEdge, kThumbWide, kThumbHigh);
  if (chosen) painter.fillRect(cell, themeColor("chosen"));
  painter.fillRect(room, themeColor("soft"));
  const auto thumb = thumbs_.find(frame);
  if (thumb != thumbs_.end() && !thumb->second.isNull()) {
    const QSize size = thumb->second.size().scaled(room.size(), Qt::KeepAspectRatio);
    painter.drawImage(QRect(room.center() - QPoint(size.width() / 2, size.height() / 2), size),
                      thumb->second);
  }
  if (chosen) {
    painter.setPen(QPen(themeColor("accent"), 2));
    painter.drawRect(room);
  }
  const int line = kEdge + kThumbHigh + kBadgeLine / 2 + 1;
  drawBadge(painter, QPointF(cell.left() + 10, line), scan_.qualityOf(frame));
  painter.setPen(themeColor("text"));
  painter.drawText(QRect(cell.left() + 18, line - kBadgeLine / 2, kCell - 22, kBadgeLine),
                   Qt::AlignRight | Qt::AlignVCenter,
                   QStringLiteral("%1 s").arg(scan_.files()->frames[frame].t, 0, 'f', 2));
}

} // namespace patina
