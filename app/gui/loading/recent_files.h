// The last files that opened, kept between sessions.
#pragma once

#include <QMenu>
#include <QObject>
#include <QStringList>

namespace patina {

class RecentFiles : public QObject {
  Q_OBJECT
 public:
  RecentFiles(QMenu& menu, QObject* parent);
  void add(const QString& path);
  QStringList paths() const;

 signals:
  void chosen(const QString& path);

 private:
  void rebuild();
  QMenu& menu_;
};

} // namespace patina
