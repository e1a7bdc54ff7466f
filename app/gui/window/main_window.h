// Connects widgets and controllers; WindowState determines what is visible.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <QElapsedTimer>
#include <QMainWindow>
#include <QTimer>

#include "app/gui/control/desk_controller.h"
#include "app/gui/control/document_controller.h"
#include "app/gui/control/edit_controller.h"
#include "app/gui/control/feel_controller.h"
#include "app/gui/control/measure_controller.h"
#include "app/gui/control/probe_controller.h"
#include "app/gui/control/view_controller.h"
#include "app/gui/painting/paint_controller.h"
#include "app/gui/window/window_layout.h"

namespace patina {

// Offers the scenes that crashes have left, one after another.
class RecoveryOffer : public QObject {
  Q_OBJECT
 public:
  RecoveryOffer(const NoticeBar& bar, QObject* parent);
  void begin() {
    places_ = recoverableScenes(stateFolder());
    emit changed();
  }
  std::optional<std::filesystem::path> present() const {
    return places_.empty() ? std::nullopt : std::optional(places_.front());
  }

 signals:
  void changed();
  void taken(const std::filesystem::path& place); // See autosave.h.

 private:
  void next() {
    places_.erase(places_.begin());
    emit changed();
  }

  std::vector<std::filesystem::path> places_; // The first is the one offered.
};

// The controllers behind the window's widgets, one for each task.
struct Controllers {
  DocumentController& documents;
  SaveController& saving;
  RecoveryOffer& recovery;
  EditController& edits;
  FeelController& feel;
  PaintController& paint;
  ViewController& view;
  DeskController& desks;
};

class MainWindow : public QMainWindow {
  Q_OBJECT
 public:
  explicit MainWindow(QWidget* parent = nullptr);

  Controllers controllers() {
    return {documents_, saving_, recovery_, edits_, feel_, paint_, view_, desks_};
  }
  // After it was closed: true if threads still read files, which nothing can interrupt.
  bool isReading() const;
  // Brings everything to disk that is there after a normal end, without waiting for these threads.
  // No other call may follow, and the process must end without destructors.
  void finishWithoutReaders();
  void restorePlace(); // Restores size and desks, and stores them at exit.

 signals:
  void sceneReady(); // A scene, or another surface of it, is shown and rendered.

 protected:
  void closeEvent(QCloseEvent* event) override;
  bool event(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void showEvent(QShowEvent* event) override;

 private:
  void addMenus(); // In window_menus.cpp.
  void searchActions();
  void connectFiles();
  void connectWelcome();
  void connectScene();
  void connectTools();
  void connectScan(); // In connect_scan.cpp.
  void tick();
  void hurry(); // Ticks as quickly as a camera motion is drawn, while the tool is dragged.
  void showTool();
  void say(Message message);
  WindowState state() const;
  void refresh() { showState(state(), parts_, *this); }
  void clear();
  void showPreview(std::shared_ptr<const TriangleMesh> mesh, const QString& name);
  void showAgain(); // Shows the scene again after a failed load.
  void showScene(const SceneChange& change);
  void askStability();

  WindowParts parts_;
  // Destroyed in reverse order, because each uses those above.
  FeelController feel_;
  ViewController view_;
  EditController edits_;
  PaintController paint_;
  ProbeController probe_;
  GapFinder gap_{this};
  MeasureController measure_;
  SaveController saving_;
  DocumentController documents_;
  RecoveryOffer recovery_;
  DeskController desks_;
  QTimer timer_;
  QElapsedTimer dragged_; // Since the last motion of a drag.
  bool stages_shown_ = true;
  double felt_ = 0; // Largest force on this surface [N].
  bool closing_ = false;
  int opened_ = 0; // Scenes that were opened so far.
  int ticks_ = 0;
};

} // namespace patina
