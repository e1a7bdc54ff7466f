// The theme that the desktop asks for, now and whenever it changes its mind: what its settings
// portal says where there is one (org.freedesktop.appearance), else the palette that Qt has of it.
#pragma once

#include <QApplication>
#include <QDBusConnection>
#include <QDBusVariant>
#include <QObject>

#include "app/gui/window/theme.h"

namespace patina {

class SystemTheme : public QObject {
  Q_OBJECT
 public:
  // Applies what is known at once; the portal's answer comes later, on the event loop.
  explicit SystemTheme(QApplication& application);
  SystemTheme(QApplication& application, QDBusConnection bus);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private slots:
  void settingChanged(const QString& space, const QString& key, const QDBusVariant& value);

 private:
  void askPortal();
  void choose();

  QApplication& application_;
  QDBusConnection bus_;
  uint asked_ = 0; // of the portal: 1 = dark, 2 = light, else it has no wish
  Theme applied_;
};

} // namespace patina
