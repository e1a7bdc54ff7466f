// The desk Texture: the demonstration from a toy's scan to haptic rendering, step by step with
// results, and the library of textures for the open scene.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <QComboBox>
#include <QGroupBox>
#include <QLabel>
#include <QPushButton>
#include <QStackedWidget>
#include <QWidget>

#include "app/gui/panels/message_panel.h"
#include "app/gui/scanning/scan_view.h"
#include "app/gui/state/window_state.h"
#include "app/gui/texturing/texture_library.h"
#include "app/gui/toolkit/background.h"
#include "app/gui/toolkit/plot.h"
#include "demo/demo.h"
#include "demo/demo_report.h"

namespace patina {

// The steps from a scan to haptic rendering: what each does, its result, and a button for the next.
class StepList : public QGroupBox {
  Q_OBJECT
 public:
  explicit StepList(QWidget* parent = nullptr);

  // demo: nullptr before the start. running: a step is running, and demo must not be read.
  void show(const Demo* demo, bool running);

 signals:
  void nextRequested();
  void allRequested();
  void feelRequested();
  void lookRequested(const QString& scan); // Shows the scan's frames.

 private:
  void offerScans(const Demo* demo);

  struct Row {
    QLabel *mark, *words, *found;
  };
  std::vector<Row> rows_;
  std::size_t done_ = 0;
  QPushButton *next_, *all_, *feel_, *look_;
};

class TextureDesk : public QObject {
  Q_OBJECT
 public:
  explicit TextureDesk(QWidget& window);
  ~TextureDesk() override;

  QStackedWidget* centralViews() const { return central_views_; }
  std::map<Panel, QWidget*> panels() const;

  TextureLibrary& library() { return library_; }
  void showLibrary(bool on); // Instead of the demonstration.

  bool hasBegun() const { return view_ != nullptr; }           // The demonstration was started.
  bool hasTexture() const { return has_texture_; }             // The demonstration has one.
  bool hasChosenTexture() const { return chosen_ != nullptr; } // One of the library.
  const std::optional<TaskProgress>& work() const { return work_; }
  void runAll() { run(true); } // Runs the whole demonstration.
  void cancel();
  void fit();
  void setView(ViewPreset view);
  void refresh() { // Called on each tick of the window.
    if (view_ != nullptr) view_->refresh();
    library_.refresh();
  }

 signals:
  void changed();
  void notified(const patina::Message& message);
  void openRequested(const QString& workspace); // An unsaved workspace.
  void scanRequested(const QString& folder);

 private:
  void run(bool all);
  void takeStep();
  void restart(); // Starts again after a failed step.
  void draw();
  void showProfile();
  void choosePage();

  // Large temporary folders, deleted with the desk. Must outlive a job that writes there.
  struct Scratch {
    std::vector<std::filesystem::path> folders;
    ~Scratch();
  };

  QWidget& window_;
  Scratch scratch_;
  Background job_;
  std::shared_ptr<Demo> demo_; // Not read while a step runs.
  std::filesystem::path folder_;
  int begun_ = 0;
  QStackedWidget* central_views_ = new QStackedWidget;
  StepList* steps_ = new StepList;
  QWidget* profile_ = new QWidget;
  QComboBox* material_ = new QComboBox;
  PlotWidget* plot_ = new PlotWidget; // Heights, spectrum and felt forces of a texture.
  ScanView* view_ = nullptr;          // Made with the first step.
  TextureLibrary library_;
  std::shared_ptr<const HapticTexture> chosen_;
  bool library_shown_ = false;
  std::optional<TaskProgress> work_;
  bool has_texture_ = false;
};

} // namespace patina
