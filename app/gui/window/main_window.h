// The window: makes widgets and controllers and connects them. What is edited, opened, felt and
// shown is the controllers', what is seen of it follows from WindowState.
#pragma once

#include <QMainWindow>
#include <QTimer>

#include "app/gui/control/controllers.h"
#include "app/gui/control/desk_controller.h"
#include "app/gui/control/document_controller.h"
#include "app/gui/control/edit_controller.h"
#include "app/gui/control/feel_controller.h"
#include "app/gui/control/view_controller.h"
#include "app/gui/loading/recovery_offer.h"
#include "app/gui/painting/paint_controller.h"
#include "app/gui/window/window_layout.h"

namespace patina {

class MainWindow : public QMainWindow {
  Q_OBJECT
 public:
  explicit MainWindow(QWidget* parent = nullptr);

  Controllers controllers() {
    return {documents_, saving_, recovery_, edits_, feel_, paint_, view_, desks_};
  }
  void restorePlace(); // size and desks as they were left, and again at the next start

 signals:
  void sceneReady(); // a scene, or another surface of it, is seen and felt

 protected:
  void closeEvent(QCloseEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void showEvent(QShowEvent* event) override;

 private:
  void connectFiles();
  void connectWelcome();
  void connectScene();
  void connectTools();
  void connectScan(); // where it is built
  void tick();
  void say(const Message& message);
  WindowState state() const;
  void refresh();     // shows the state
  void comeInSight(); // to a desk that shows what is open, or else the page to begin from
  void clear();
  void showPreview(std::shared_ptr<const TriangleMesh> mesh, const QString& name);
  void showAgain(); // what was open before a load that came to nothing
  void showScene(const SceneChange& change);
  void askStability();

  WindowParts parts_;
  // Each goes before those above it, which it uses.
  FeelController feel_;
  ViewController view_;
  EditController edits_;
  PaintController paint_;
  SaveController saving_;
  DocumentController documents_;
  RecoveryOffer recovery_;
  DeskController desks_;
  QTimer timer_;
  bool stages_shown_ = true;
  double felt_ = 0; // the greatest force, since the surface is this one [N]
  bool closing_ = false;
  int ticks_ = 0;
};

} // namespace patina
