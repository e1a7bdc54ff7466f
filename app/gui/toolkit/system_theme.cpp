#include "app/gui/toolkit/system_theme.h"

#include <utility>

#include <QDBusMessage>
#include <QDBusPendingCallWatcher>
#include <QDBusPendingReply>
#include <QEvent>
#include <QSettings>

namespace patina {
namespace {

const QString kService = QStringLiteral("org.freedesktop.portal.Desktop");
const QString kPath = QStringLiteral("/org/freedesktop/portal/desktop");
const QString kSettings = QStringLiteral("org.freedesktop.portal.Settings");
const QString kSpace = QStringLiteral("org.freedesktop.appearance");
const QString kKey = QStringLiteral("color-scheme");

// Asking for a session bus may start one, so it is skipped without an address.
QDBusConnection sessionBus() {
  return qEnvironmentVariableIsSet("DBUS_SESSION_BUS_ADDRESS")
             ? QDBusConnection::sessionBus()
             : QDBusConnection(QStringLiteral("patina-no-bus"));
}

// The portal wraps its answer once or twice, depending on its version.
QVariant unwrapped(QVariant value) {
  while (value.canConvert<QDBusVariant>()) value = value.value<QDBusVariant>().variant();
  return value;
}

} // namespace

QString keptTheme() {
  return QSettings().value(QStringLiteral("theme")).toString();
}

void keepTheme(const QString& theme) {
  QSettings().setValue(QStringLiteral("theme"), theme);
  QEvent changed(QEvent::ThemeChange);
  QCoreApplication::sendEvent(QCoreApplication::instance(), &changed);
}

SystemTheme::SystemTheme(QApplication& application) : SystemTheme(application, sessionBus()) {}

SystemTheme::SystemTheme(QApplication& application, QDBusConnection bus)
    : application_(application), bus_(std::move(bus)), applied_(wanted()) {
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
  preference_ = unwrapped(value.variant()).toUInt();
  choose();
}

bool SystemTheme::eventFilter(QObject* watched, QEvent* event) {
  // The platform's palette has changed.
  if (event->type() == QEvent::ThemeChange) choose();
  return QObject::eventFilter(watched, event);
}

Theme SystemTheme::wanted() const {
  const QString kept = keptTheme();
  if (kept == QStringLiteral("dark")) return Theme::dark;
  if (kept == QStringLiteral("light")) return Theme::light;
  return preference_ == 1 ? Theme::dark : preference_ == 2 ? Theme::light : systemTheme();
}

void SystemTheme::choose() {
  if (wanted() == applied_) return;
  applied_ = wanted();
  applyStyle(application_, applied_);
}

} // namespace patina
