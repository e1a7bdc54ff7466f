#include "app/gui/loading/file_drop.h"

#include <QDragEnterEvent>
#include <QMimeData>
#include <QUrl>

namespace patina {

FileDrop::FileDrop(QWidget& on) : QObject(&on) {
  on.setAcceptDrops(true);
  on.installEventFilter(this);
}

bool FileDrop::eventFilter(QObject*, QEvent* event) {
  if (event->type() == QEvent::DragEnter) {
    auto* drag = static_cast<QDragEnterEvent*>(event);
    const QMimeData& data = *drag->mimeData();
    if (data.hasUrls() && data.urls().front().isLocalFile()) drag->acceptProposedAction();
    return true;
  }
  if (event->type() != QEvent::Drop) return false;
  const QString path = static_cast<QDropEvent*>(event)->mimeData()->urls().front().toLocalFile();
  // A question must not hold up the program that the file is dragged from.
  QMetaObject::invokeMethod(
      this, [this, path] { emit dropped(path); }, Qt::QueuedConnection);
  return true;
}

} // namespace patina
