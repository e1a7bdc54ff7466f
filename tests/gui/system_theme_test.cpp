// The window becomes dark at once if the desktop is set to dark.
#include <QDBusConnectionInterface>
#include <QDBusMessage>
#include <QDBusVirtualObject>
#include <QProcess>

#include "app/gui/toolkit/system_theme.h"
#include "gui/window_fixture.h"

namespace patina {
namespace {

// A desktop's settings portal: it answers requests and reports changes.
class Portal : public QDBusVirtualObject {
 public:
  explicit Portal(QDBusConnection bus) : bus_(std::move(bus)) {
    bus_.registerVirtualObject(QStringLiteral("/org/freedesktop/portal/desktop"), this);
    bus_.registerService(QStringLiteral("org.freedesktop.portal.Desktop"));
  }
  QString introspect(const QString&) const override { return {}; }
  bool handleMessage(const QDBusMessage& message, const QDBusConnection& bus) override {
    if (message.member() != QStringLiteral("Read")) return false;
    const QVariant wrapped = QVariant::fromValue(QDBusVariant(scheme));
    return bus.send(message.createReply(QVariant::fromValue(QDBusVariant(wrapped))));
  }
  void change(uint now, const QString& key = QStringLiteral("color-scheme")) {
    scheme = now;
    QDBusMessage told = QDBusMessage::createSignal(
        QStringLiteral("/org/freedesktop/portal/desktop"),
        QStringLiteral("org.freedesktop.portal.Settings"), QStringLiteral("SettingChanged"));
    told << QStringLiteral("org.freedesktop.appearance") << key
         << QVariant::fromValue(QDBusVariant(now));
    bus_.send(told);
  }
  uint scheme = 1;

 private:
  QDBusConnection bus_;
};

class SystemThemeTest : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (IsSkipped()) return;
    daemon_.start(QStringLiteral("dbus-daemon"),
                  {QStringLiteral("--session"), QStringLiteral("--nofork"),
                   QStringLiteral("--print-address")});
    ASSERT_TRUE(daemon_.waitForStarted(3000)) << "install dbus-daemon";
    ASSERT_TRUE(daemon_.waitForReadyRead(3000));
    address_ = QString::fromUtf8(daemon_.readLine()).trimmed();
  }
  void TearDown() override {
    for (const char* name : {"desktop", "window"})
      QDBusConnection::disconnectFromBus(QString::fromUtf8(name));
    daemon_.kill();
    daemon_.waitForFinished(3000);
    if (!IsSkipped()) applyStyle(application(), Theme::light);
    WindowTest::TearDown();
  }
  QDBusConnection connection(const char* name) {
    return QDBusConnection::connectToBus(address_, QString::fromUtf8(name));
  }
  // Returns whether the background of all widgets becomes this colour.
  bool becomes(const char* window) {
    return waitUntil([&] { return window_->palette().color(QPalette::Window) == window; }, 3000);
  }
  static constexpr const char *kDark = "#23272e", *kLight = "#f1f3f6";

  QProcess daemon_;
  QString address_;
};

TEST_F(SystemThemeTest, FollowsThePortalWhileTheWindowIsOpen) {
  Portal portal(connection("desktop"));
  const SystemTheme theme(application(), connection("window"));
  EXPECT_TRUE(becomes(kDark)); // the requested value
  portal.change(2);
  EXPECT_TRUE(becomes(kLight));
  portal.change(1);
  EXPECT_TRUE(becomes(kDark));
  EXPECT_EQ(view().view().renderer().GetBackground()[0], palette::kDark.low[0]);
  portal.change(1, QStringLiteral("contrast")); // another kind of setting
  portal.change(0);                             // no preference: the palette of the platform
  EXPECT_TRUE(becomes(kLight));
  EXPECT_EQ(view().view().renderer().GetBackground()[0], palette::kLight.low[0]);
}

TEST_F(SystemThemeTest, FallsBackToThePlatformsPaletteWithoutAPortalOrABus) {
  applyStyle(application(), Theme::dark);
  const SystemTheme alone(application(), QDBusConnection(QStringLiteral("nothing")));
  EXPECT_TRUE(becomes(kLight));
  applyStyle(application(), Theme::dark);
  const SystemTheme unanswered(application(), connection("window"));
  EXPECT_TRUE(becomes(kLight));
}

} // namespace
} // namespace patina
