// The first hour's page leads from nothing to a calibrated rig, by pointer and keys.
#include <QLineEdit>

#include "app/gui/scanning/first_hour_page.h"
#include "app/gui/scanning/scan_desk.h"
#include "gui/driven_window.h"
#include "gui/misfits.h"
#include "support/first_hour.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class FirstHourTest : public DrivenWindow {
 protected:
  void clickHere(const QString& name) {
    ++clicks_;
    clickOn(name);
  }
  // A click into the line, and what is typed replaces its text.
  void fill(const QString& name, const std::string& text) {
    ++clicks_;
    click(*find<QLineEdit>(name));
    type('a', kControl);
    type(QString::fromStdString(text));
  }
  FirstHourPage& page() { return *find<FirstHourPage>("first_hour"); }
  std::string words(const QString& name) { return find<QLabel>(name)->text().toStdString(); }
  bool isMarked(const QString& step) {
    return find<QLabel>(step + "_mark")->text() == QStringLiteral("✓");
  }
  void keepPicture(const QString& name) {
    if (const char* folder = std::getenv("PATINA_PICTURES"))
      window_->grab().save(QStringLiteral("%1/%2.png").arg(QString::fromUtf8(folder), name));
  }
  void expectNoMisfits(const std::string& where) {
    QCoreApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest);
    const QStringList cut = test::misfits(*window_), mute = test::muteControls(*window_);
    EXPECT_TRUE(cut.isEmpty()) << where << "\n  " << cut.join("\n  ").toStdString();
    EXPECT_TRUE(mute.isEmpty()) << where << "\n  " << mute.join("\n  ").toStdString();
  }

  int clicks_ = 0;
};

TEST_F(FirstHourTest, LeadsFromNothingToACalibratedRigInAtMostTwelveClicks) {
  const Camera camera = usualCamera();
  const fs::path rig = folder_ / "rig", board = folder_ / "board", wave = folder_ / "wave";
  ++clicks_;
  clickAction("desk_scan");
  fill("hour_folder", rig.string());
  clickHere("hour_print");
  ASSERT_TRUE(waitUntil([&] { return isMarked("hour_print"); })) << words("hour_note");
  EXPECT_EQ(words("hour_print_words").find("5 markers of 27"), 0u) << words("hour_print_words");
  EXPECT_TRUE(fs::exists(rig / "board.pdf"));

  test::writeBoardFrames(board, camera, parseBoard(page().hour().board));
  fill("hour_camera", "replay:" + board.string());
  clickHere("hour_photograph");
  const auto shows = [&](const char* what) {
    return words("hour_summary").find(what) != std::string::npos;
  };
  // A busy machine may show the last pictures at once.
  ASSERT_TRUE(waitUntil([&] { return shows(" of 4 tilts") || isMarked("hour_photograph"); }))
      << words("hour_note") << words("hour_summary") << words("hour_advice");
  keepPicture("hour_board");
  ASSERT_TRUE(waitUntil([&] { return isMarked("hour_photograph"); })) << words("hour_note");
  EXPECT_NE(words("hour_photograph_words").find("px rms"), std::string::npos);

  const test::GluedRig glued(rig / "rig.json");
  glued.writeWave(wave, camera);
  fill("hour_camera", wave.string());
  fill("hour_measured", std::to_string(1e3 * glued.markers[0].size) + "mm");
  clickHere("hour_wave");
  ASSERT_TRUE(waitUntil([&] { return shows("with a pose: ") || isMarked("hour_wave"); }));
  keepPicture("hour_wave");
  ASSERT_TRUE(waitUntil([&] { return isMarked("hour_wave"); }, 120000)) << words("hour_note");
  keepPicture("hour_done");
  std::printf("%d clicks, tip off by %.3f mm\n", clicks_, 1e3 * glued.tipError(rig / "rig.json"));
  EXPECT_LE(clicks_, 12);
  EXPECT_LT(glued.tipError(rig / "rig.json"), 0.15e-3);
  EXPECT_TRUE(fs::exists(rig / "rig.json~")); // the nominal places

  // Printing again would replace what was found.
  const std::string before = readFile(rig / "rig.json");
  clickHere("hour_print");
  ASSERT_TRUE(
      waitUntil([&] { return words("hour_note").find("is calibrated") != std::string::npos; }));
  EXPECT_EQ(readFile(rig / "rig.json"), before);
  clickHere("hour_scan");
  auto& scan = *window_->findChild<OpenScan*>();
  ASSERT_TRUE(waitUntil([&] {
    return scan.files() != nullptr && !scan.grows() && scan.files()->folder == rig / "scan";
  }));
  EXPECT_TRUE(readFirstHour(rig).scan.done);
}

TEST_F(FirstHourTest, PageFitsAtEverySizeInBothThemes) {
  for (const Theme theme : {Theme::light, Theme::dark}) {
    applyStyle(application(), theme);
    clickAction("desk_scan");
    for (const QSize& size : {QSize(1024, 700), QSize(1920, 1080)}) {
      takeSize(size.width(), size.height());
      wait(100);
      expectNoMisfits(std::to_string(size.width()));
      keepPicture(QStringLiteral("hour_%1_%2").arg(size.width()).arg(static_cast<int>(theme)));
    }
  }
  applyStyle(application(), Theme::light);
}

TEST_F(FirstHourTest, FailuresAreNamedOnThePageAndChangeNothing) {
  ++clicks_;
  clickAction("desk_scan");
  fill("hour_folder", (folder_ / "rig").string());
  fill("hour_camera", (folder_ / "none").string());
  clickHere("hour_photograph");
  ASSERT_TRUE(waitUntil([&] { return words("hour_note").find("none") != std::string::npos; }));
  EXPECT_FALSE(isMarked("hour_photograph"));
  EXPECT_FALSE(find<QPushButton>("hour_wave")->isEnabled());
  EXPECT_FALSE(find<QPushButton>("hour_scan")->isEnabled());
  EXPECT_FALSE(fs::exists(folder_ / "rig" / "camera.yml"));
}

} // namespace
} // namespace patina
