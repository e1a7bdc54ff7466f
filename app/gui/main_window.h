// The window: puts the panels around the 3D view and passes values between them, the loader and the
// servo. Everything that computes is elsewhere.
#pragma once

#include <QLabel>
#include <QMainWindow>
#include <QTimer>

#include "app/gui/device_panel.h"
#include "app/gui/display_panel.h"
#include "app/gui/feel_host.h"
#include "app/gui/haptics_panel.h"
#include "app/gui/live_plots.h"
#include "app/gui/load_bar.h"
#include "app/gui/object_list.h"
#include "app/gui/object_panel.h"
#include "app/gui/recent_files.h"
#include "app/gui/recording.h"
#include "app/gui/scene_loader.h"
#include "app/gui/scene_widget.h"
#include "app/gui/stability_job.h"
#include "app/gui/status_line.h"

namespace patina {

class MainWindow : public QMainWindow {
  Q_OBJECT
 public:
  explicit MainWindow(QWidget* parent = nullptr);
  ~MainWindow() override;

  void open(const LoadRequest& request);
  void saveWorkspaceTo(const QString& folder); // throws Error
  void startRecording();                       // what R does; the log is a recording of its own
  // Every tick since startRecording(), and recording ends.
  std::vector<ToolSample> takeRecording();
  const Recording& recording() const { return recording_; }
  void startLog();
  Recording& log(); // up to this tick
  // Whether closing asks about what is not saved; a script's window has nobody to ask.
  void setAsks(bool asks) { asks_ = asks; }

  const CompiledScene* scene() const { return current_.get(); }
  std::shared_ptr<const CompiledScene> current() const { return current_; }
  SceneWidget& view() { return *view_; }
  DisplayPanel& display() { return *display_; }
  HapticsPanel& haptics() { return *haptics_; }
  DevicePanel& device() { return *device_; }
  ObjectList& objects() { return *objects_; }
  SceneLoader& loader() { return *loader_; }
  FeelHost& feel() { return feel_; }
  StabilityJob& stability() { return *stability_; }
  EnergyPlot& energyPlot() { return *energy_plot_; }
  StatusLine& status() { return *status_; }
  const ToolSample& lastSample() const { return last_sample_; }
  void setMode(SceneWidget::Mode mode);

 signals:
  void sceneReady();
  void loadFailed(const QString& message);
  void loadCancelled();

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void closeEvent(QCloseEvent* event) override;

 private:
  void buildLayout();
  void buildMenus();
  void connectLoader();
  void tick();
  void showPreview(std::shared_ptr<const TriangleMesh> mesh, const QString& name);
  void take(std::shared_ptr<const CompiledScene> scene, const QStringList& warnings);
  void restore(); // what was open before a load that came to nothing
  void showCurrent();
  void connectPanels();
  QList<QWidget*> cards() const; // of the side panel, in their order
  void takeRebuilt(std::shared_ptr<const CompiledScene> scene, const QStringList& warnings);
  void showSurface();  // mesh and field of current_
  void showValues();   // whatever depends on values of touch and device
  void applyValues();  // of touch and device
  void applyObjects(); // starts a rebuild, now or when the one under way has ended
  void openFeelAt(const Vec3& start);
  void askStability();
  void openDialog(bool adds);
  bool saveDialog();                          // false: nothing was saved
  void openAsked(const LoadRequest& request); // unless the person would rather keep their edits
  void exportDialog();
  void recordDialog(bool on);
  bool saveRecordingDialog(); // false: not written, the samples are kept
  bool settleEdits();
  bool settleRecording(); // saved or dropped; false: the person goes on
  void collect();         // what the servo has said since the last time
  void closeFeel();       // and nothing that it said is lost

  SceneWidget* view_;
  LoadBar* load_bar_;
  QLabel* warnings_;
  ObjectList* objects_;
  ObjectPanel* object_;
  HapticsPanel* haptics_;
  DevicePanel* device_;
  DisplayPanel* display_;
  ForcePlot* force_plot_;
  EnergyPlot* energy_plot_;
  StatusLine* status_;
  RecentFiles* recent_ = nullptr;
  SceneLoader* loader_;
  StabilityJob* stability_;
  QAction* feel_action_ = nullptr;
  QAction* navigate_action_ = nullptr;
  QAction* save_action_ = nullptr;
  QAction* record_action_ = nullptr;
  QList<QAction*> panels_; // show and hide the docks

  FeelHost feel_;
  QTimer timer_;
  std::shared_ptr<const CompiledScene> current_;
  bool previewing_ = false;
  bool values_edited_ = false;  // and not yet felt
  bool objects_edited_ = false; // and not yet on their way
  int ticks_ = 0;
  ToolSample last_sample_;
  Recording recording_, log_;
  bool asks_ = true;
  bool closing_ = false;
};

} // namespace patina
