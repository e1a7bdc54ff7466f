#include "app/gui/window/system_theme.h"

#include <utility>

#include <QDBusMessage>
#include <QDBusPendingCallWatcher>
#include <QDBusPendingReply>
#include <QEvent>

namespace patina {
namespace {

const QString kService = QStringLiteral("org.freedesktop.portal.Desktop");
const QString kPath = QStringLiteral("/org/freedesktop/portal/desktop");
const QString kSettings = QStringLiteral("org.freedesktop.portal.Settings");
const QString kSpace = QStringLiteral("org.freedesktop.appearance");
const QString kKey = QStringLiteral("color-scheme");

// Where no session has a bus, asking for one may start one.
QDBusConnection sessionBus() {
  return qEnvironmentVariableIsSet("DBUS_SESSION_BUS_ADDRESS")
             ? QDBusConnection::sessionBus()
             : QDBusConnection(QStringLiteral("patina-no-bus"));
}

// The portal wraps what it says once or twice, by its version.
QVariant unwrapped(QVariant value) {
  while (value.canConvert<QDBusVariant>()) value = value.value<QDBusVariant>().variant();
  return value;
}

} // namespace

SystemTheme::SystemTheme(QApplication& application) : SystemTheme(application, sessionBus()) {}

SystemTheme::SystemTheme(QApplication& application, QDBusConnection bus)
    : application_(application), bus_(std::move(bus)), applied_(systemTheme()) {
  applyStyle(application_, applied_);
  application_.installEventFilter(this);
  if (!bus_.isConnected()) return;
  bus_.connect(kService, kPath, kSettings, QStringLiteral("SettingChanged"), this,
               SLOT(settingChanged(QString, QString, QDBusVariant)));
  askPortal();
}

void SystemTheme::askPortal() {
  QDBusMessage read =
      QDBusMessage::createMethodCall(kService, kPath, kSettings, QStringLiteral("Read"));
  read << kSpace << kKey;
  auto* answer = new QDBusPendingCallWatcher(bus_.asyncCall(read), this);
  connect(answer, &QDBusPendingCallWatcher::finished, this, [this, answer] {
    const QDBusPendingReply<QDBusVariant> reply = *answer;
    if (!reply.isError()) settingChanged(kSpace, kKey, reply.value());
    answer->deleteLater();
  });
}

void SystemTheme::settingChanged(const QString& space, const QString& key,
                                 const QDBusVariant& value) {
  if (space != kSpace || key != kKey) return;
  asked_ = unwrapped(value.variant()).toUInt();
  choose();
}

bool SystemTheme::eventFilter(QObject* watched, QEvent* event) {
  // The platform has another palette.
  if (event->type() == QEvent::ThemeChange) choose();
  return QObject::eventFilter(watched, event);
}

void SystemTheme::choose() {
  const Theme wanted = asked_ == 1 ? Theme::dark : asked_ == 2 ? Theme::light : systemTheme();
  if (wanted == applied_) return;
  applied_ = wanted;
  applyStyle(application_, applied_);
}

} // namespace patina
