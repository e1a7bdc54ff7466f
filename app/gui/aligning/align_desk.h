// The desk on which a path is laid onto the mesh by hand: four views at once, six values, three
// points, a fit from there; what it is off, live.
#pragma once

#include <filesystem>
#include <optional>

#include <QLabel>
#include <QPushButton>
#include <QStackedWidget>
#include <QTimer>

#include "app/gui/aligning/align_panel.h"
#include "app/gui/aligning/align_view.h"
#include "app/gui/aligning/basin_plot.h"
#include "app/gui/panels/message_panel.h"
#include "app/gui/window/background.h"
#include "app/gui/window/window_state.h"
#include "scene/scene.h"

namespace patina {

class AlignDesk : public QObject {
  Q_OBJECT
 public:
  explicit AlignDesk(QWidget& window); // to which it belongs

  // To be laid out by the window.
  QStackedWidget* cells() const { return cells_; }
  QWidget* panel() const { return panel_; }
  QWidget* basin() const { return plot_; }

  const Alignment& alignment() const { return alignment_; }
  // Of the fit that put the path where it is; nullopt: a hand did.
  const std::optional<Registration>& found() const { return found_; }
  const QString& name() const { return name_; } // of the path
  const std::optional<Work>& work() const { return work_; }

  void openPath(const std::filesystem::path& file);
  void setPath(const QString& name, std::vector<PathSample> path); // not yet told by contact
  // That lies beside the path, to be opened where no scene is; empty: none.
  void offerMesh(const std::filesystem::path& file);
  void setSceneMesh(std::shared_ptr<const TriangleMesh> mesh); // nullptr: no scene is open
  void setScans(std::shared_ptr<const Scene> scene);           // whose paths can be chosen
  void openScan(const QString& name);                          // of the scene
  void cancel();
  void fit();
  void undo();
  void redo();
  void refresh(); // of every tick of the window

 signals:
  void changed();
  void meshAsked(const QString& file);
  void said(const patina::Message& message);
  void storeAsked(const patina::SceneScan& scan); // with where it lies

 private:
  void makeViews();
  void openDialog();
  void keepDialog();
  void keep(const std::filesystem::path& file);
  void store();
  void begin();                                   // another path or mesh
  void move(const Pose& pose);                    // while a hand moves it
  void settle();                                  // it has
  void settleBy(std::optional<Registration> fit); // nullopt: a hand has
  void draw();
  void drawMap();
  void forgetMap(); // of where the path lay before
  void lookAbout();
  void registerFromHere();
  void setPicking(bool on);
  void pick(const Ray& sight, double reach);
  void askForPoint();

  QWidget& window_;
  Background fit_job_, basin_job_;
  Alignment alignment_;
  QString name_;
  std::shared_ptr<const Scene> scene_;
  QStackedWidget* cells_ = new QStackedWidget;
  QLabel* empty_ = new QLabel;
  QPushButton* offer_ = new QPushButton;
  std::filesystem::path offered_;
  AlignPanel* panel_ = new AlignPanel;
  BasinPlot* plot_ = new BasinPlot;
  std::vector<AlignView*> views_; // made with the first path
  QTimer settle_;
  std::optional<Registration> found_;
  std::vector<float> error_;            // one a vertex [m]; empty: not known of where the path lies
  double reach_ = 1;                    // of the sliders [m]
  Pose held_ = Pose::Identity();        // as it was when a drag began
  std::vector<Vec3> on_path_, on_mesh_; // that were picked
  bool picks_ = false, stale_ = false;  // stale: moved since it was drawn
  std::optional<Work> work_;
};

} // namespace patina
