// The window: puts the panels around the 3D view and passes values between them, the edit thread
// and the servo. Everything that computes is elsewhere.
#pragma once

#include <QDockWidget>
#include <QLabel>
#include <QMainWindow>
#include <QTimer>

#include "app/gui/loading/load_bar.h"
#include "app/gui/loading/recent_files.h"
#include "app/gui/loading/recover_bar.h"
#include "app/gui/loading/scene_loader.h"
#include "app/gui/painting/paint_controller.h"
#include "app/gui/painting/paint_display.h"
#include "app/gui/painting/relief_panel.h"
#include "app/gui/panels/device_panel.h"
#include "app/gui/panels/display_panel.h"
#include "app/gui/panels/haptics_panel.h"
#include "app/gui/panels/history_panel.h"
#include "app/gui/panels/object_list.h"
#include "app/gui/panels/object_panel.h"
#include "app/gui/servo/live_plots.h"
#include "app/gui/servo/recording.h"
#include "app/gui/servo/stability_job.h"
#include "app/gui/window/scene_widget.h"
#include "app/gui/window/status_line.h"
#include "haptics/servo/tip_servo.h"
#include "session/edit/edit_thread.h"

namespace patina {

class MainWindow : public QMainWindow {
  Q_OBJECT
 public:
  explicit MainWindow(QWidget* parent = nullptr);
  ~MainWindow() override;

  void open(const LoadRequest& request);
  // Events go on until it is there; throws Error.
  void saveWorkspaceTo(const QString& folder);
  void offerRecovery();  // of what a crash has left behind, if anything
  void startRecording(); // what R does; the log is a recording of its own
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
  TipServo& feel() { return feel_; }
  StabilityJob& stability() { return *stability_; }
  EnergyPlot& energyPlot() { return *energy_plot_; }
  StatusLine& status() { return *status_; }
  EditThread& edits() { return *edits_; }
  const EditStatus& standing() const { return standing_; } // of the history
  ToolBar& tools() { return *tools_; }
  PaintController& desk() { return *desk_; }
  BrushPanel& brushPanel() { return *brush_; }
  ReliefPanel& relief() { return *relief_; }
  PaintDisplay& paintDisplay() { return *paint_display_; }
  HistoryPanel& history() { return *history_; }
  const ToolSample& lastSample() const { return last_sample_; }
  void setMode(SceneWidget::Mode mode); // as its tool in the tool bar does

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
  QDockWidget* dock(const QString& title, const char* name, QWidget* widget,
                    Qt::DockWidgetArea area);
  void buildMenus();
  void buildEditMenu();
  void buildViewMenu();
  void buildHelpMenu();
  void connectLoader();
  void connectPanels();
  void connectPaint();
  QList<QWidget*> cards() const; // of the side panel that every scene has, in their order
  void tick();

  void takeNews();
  void takeStanding(const EditStatus& standing);
  void takeScene(const EditEvents& news);
  void showDoing(const std::optional<EditProgress>& doing);
  void showPreview(std::shared_ptr<const TriangleMesh> mesh, const QString& name);
  void take(OpenedEditor& opened);
  void restore(); // what was open before a load that came to nothing
  void showCurrent();
  void showSurface(); // mesh and field of current_
  void showPaint();
  void showValues(); // whatever depends on values of touch and device
  void syncPanels(); // after undo and redo: as the scene is
  void showRelief();
  void showWarnings(const QStringList& lines);
  void openFeelAt(const Vec3& start);
  void askStability();

  void tryValues();    // of touch and device, as the panels have them
  void applyObjects(); // as the panel has them
  void addObjects(const OpenedScene& opened);
  void chooseTool(const ToolChoice& choice);
  void waitFor(const std::function<void(EditThread::Done)>& ask); // throws Error; events go on

  void openDialog(bool adds);
  void save();
  bool saveNow();                             // false: nothing was saved
  bool saveDialog();                          // the same, into a folder that is asked for
  void openAsked(const LoadRequest& request); // unless the person would rather keep their edits
  void loadProblem(const QString& message);
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
  PaintDisplay* paint_display_;
  BrushPanel* brush_;
  ReliefPanel* relief_;
  HistoryPanel* history_;
  ToolBar* tools_;
  RecoverBar* recover_;
  ForcePlot* force_plot_;
  EnergyPlot* energy_plot_;
  StatusLine* status_;
  RecentFiles* recent_ = nullptr;
  SceneLoader* loader_;
  StabilityJob* stability_;
  PaintController* desk_ = nullptr;
  QDockWidget* history_dock_ = nullptr;
  QAction* save_action_ = nullptr;
  QAction* save_as_action_ = nullptr;
  QAction* undo_action_ = nullptr;
  QAction* redo_action_ = nullptr;
  QAction* record_action_ = nullptr;
  QList<QAction*> views_;  // fit and the camera's places
  QList<QAction*> panels_; // show and hide the docks

  TipServo feel_;
  std::unique_ptr<EditThread> edits_; // goes before feel_, to which it publishes
  QTimer timer_;
  std::shared_ptr<const CompiledScene> current_;
  EditStatus standing_;
  QString name_; // of what is open
  ToolChoice before_navigating_;
  bool previewing_ = false;
  bool values_edited_ = false;               // and not yet asked for
  int values_asked_ = 0, objects_asked_ = 0; // and not yet answered
  bool stages_shown_ = true;
  int ticks_ = 0;
  ToolSample last_sample_;
  Recording recording_, log_;
  bool asks_ = true;
  bool closing_ = false;
};

} // namespace patina
