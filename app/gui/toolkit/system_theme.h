// Follows the theme of the desktop and its changes: the settings portal
// (org.freedesktop.appearance) if there is one, otherwise the palette that Qt has of it.
#pragma once

#include <QApplication>
#include <QDBusConnection>
#include <QDBusVariant>
#include <QObject>

#include "app/gui/toolkit/theme.h"

namespace patina {

// The theme that the user has chosen, "light" or "dark"; empty: that of the desktop.
QString keptTheme();
void keepTheme(const QString& theme); // A SystemTheme applies it at once.

class SystemTheme : public QObject {
  Q_OBJECT
 public:
  // Applies the known theme at once; the portal answers later.
  explicit SystemTheme(QApplication& application);
  SystemTheme(QApplication& application, QDBusConnection bus);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private slots:
  void settingChanged(const QString& space, const QString& key, const QDBusVariant& value);

 private:
  void askPortal();
  Theme wanted() const;
  void choose();

  QApplication& application_;
  QDBusConnection bus_;
  uint preference_ = 0; // Answer of the portal: 1 = dark, 2 = light, otherwise no preference.
  Theme applied_;
};

} // namespace patina
