// A simulated scan with one of each fault, and a window that is driven like by a user.
#pragma once

#include <cstdlib>
#include <fstream>

#include <QPushButton>

#include "acquisition/files/scan_tables.h"
#include "app/gui/scanning/frame_strip.h"
#include "app/gui/scanning/scan_desk.h"
#include "app/gui/scanning/scan_traces.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "support/fresh_folder.h"
#include "support/places.h"

namespace patina {

inline constexpr std::size_t kUnreadable = 12, kWrong = 25; // frames

class ScanDeskTest : public DrivenWindow {
 protected:
  // One folder a program, shared with the programs that it starts.
  class Made {
   public:
    Made() {
      if (const char* known = std::getenv(kPlace)) {
        scan_ = known;
        return;
      }
      folder_ = test::freshFolder("made");
      scan_ = folder_ / "a scan of a sphere";
      writeMesh(folder_ / "sphere.obj", icosphere(40, 12)); // mm
      const std::string command = "'" + (test::programFolder() / "patina").string() +
                                  "' simulate-scan '" + (folder_ / "sphere.obj").string() +
                                  "' --frames --seconds 3 --dropouts 1 -o '" + scan_.string() +
                                  "' > /dev/null 2>&1";
      EXPECT_EQ(std::system(command.c_str()), 0) << command;
      setenv(kPlace, scan_.c_str(), 1);
    }
    ~Made() {
      std::error_code none;
      if (!folder_.empty()) std::filesystem::remove_all(folder_, none);
    }
    const std::filesystem::path& scan() const { return scan_; }

   private:
    static constexpr const char* kPlace = "PATINA_MADE_SCAN";
    std::filesystem::path folder_, scan_;
  };

  void SetUp() override {
    DrivenWindow::SetUp();
    if (IsSkipped()) return;
    static const Made made;
    scan_ = folder_ / made.scan().filename();
    std::filesystem::copy(made.scan(), scan_, std::filesystem::copy_options::recursive);
    std::ofstream(frame(kUnreadable), std::ios::trunc) << "no picture";
    std::filesystem::copy_file(frame(kWrong - 15), frame(kWrong),
                               std::filesystem::copy_options::overwrite_existing);
  }
  std::filesystem::path frame(std::size_t i) const {
    char name[32];
    std::snprintf(name, sizeof name, "%06zu.png", i);
    return scan_ / "frames" / name;
  }
  ScanDesk& desk() { return *window_->findChild<ScanDesk*>(); }
  OpenScan& scan() { return *window_->findChild<OpenScan*>(); }
  QString why() { return find<QLabel>("frame_why")->text(); }
  bool openScan() {
    documents().open(requestFor(scan_));
    const bool done = waitUntil([&] {
      return scan().path() != nullptr && !desk().work() && !scan().seen().empty() &&
             scan().seen().back().looked;
    });
    wait(300);
    return done;
  }
  void clickIn(QWidget& widget, const QPoint& place) {
    pointAt(widget.mapToGlobal(place));
    press(), release();
    wait(250);
  }
  const Finding* findingOf(Finding::Kind kind) {
    for (const Finding& finding : scan().path()->findings)
      if (finding.kind == kind) return &finding;
    return nullptr;
  }
  void keepPicture(const QString& name) {
    if (const char* folder = std::getenv("PATINA_PICTURES"))
      window_->grab().save(QStringLiteral("%1/%2.png").arg(QString::fromUtf8(folder), name));
  }

  std::filesystem::path scan_;
};

} // namespace patina
