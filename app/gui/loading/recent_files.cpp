#include "app/gui/loading/recent_files.h"

#include <QFileInfo>
#include <QSettings>

namespace patina {
namespace {
constexpr int kKept = 8;
const QString kKey = QStringLiteral("recent_files");
} // namespace

RecentFiles::RecentFiles(QMenu& menu, QObject* parent) : QObject(parent), menu_(menu) {
  rebuild();
}

QStringList RecentFiles::paths() const {
  return QSettings().value(kKey).toStringList();
}

void RecentFiles::add(const QString& path) {
  const QString absolute = QFileInfo(path).absoluteFilePath();
  QStringList list = paths();
  list.removeAll(absolute);
  list.prepend(absolute);
  while (list.size() > kKept) list.removeLast();
  QSettings().setValue(kKey, list);
  rebuild();
}

void RecentFiles::rebuild() {
  menu_.clear();
  for (const QString& path : paths()) {
    QAction* action = menu_.addAction(QFileInfo(path).fileName());
    action->setToolTip(path);
    connect(action, &QAction::triggered, this, [this, path] { emit chosen(path); });
  }
  menu_.setToolTipsVisible(true);
  menu_.setEnabled(!menu_.isEmpty());
}

} // namespace patina
