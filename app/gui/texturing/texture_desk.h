// The desk on which a scan becomes a feel: the guided sequence on the toy's scan, step by step,
// with what each step found; and the library of textures, laid on what is open.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include <QComboBox>
#include <QStackedWidget>

#include "app/gui/panels/message_panel.h"
#include "app/gui/scanning/scan_view.h"
#include "app/gui/texturing/profile_plot.h"
#include "app/gui/texturing/step_list.h"
#include "app/gui/texturing/texture_library.h"
#include "app/gui/window/background.h"
#include "app/gui/window/window_state.h"

namespace patina {

class TextureDesk : public QObject {
  Q_OBJECT
 public:
  explicit TextureDesk(QWidget& window); // to which it belongs
  ~TextureDesk() override;

  // To be laid out by the window.
  QStackedWidget* cells() const { return cells_; }
  std::map<Panel, QWidget*> panels() const;

  TextureLibrary& library() { return library_; }
  void showLibrary(bool on); // in the place of the sequence

  bool hasBegun() const { return view_ != nullptr; } // and is shown in the cells, or the library is
  bool hasTexture() const { return has_texture_; }   // of the sequence
  bool hasChosenTexture() const { return chosen_ != nullptr; } // of the library
  const std::optional<Work>& work() const { return work_; }
  void runAll(); // the whole sequence
  void cancel();
  void fit();
  void setView(ViewPreset view);
  void refresh(); // of every tick of the window

 signals:
  void changed();
  void said(const patina::Message& message);
  void openAsked(const QString& workspace); // which nobody has saved yet
  void scanAsked(const QString& folder);

 private:
  void run(bool all);
  void takeStep();
  void beginAnew(); // of a step that came to nothing
  void draw();
  void showProfile();
  void choosePage();

  // Hundreds of megabytes that nobody named: they go with the desk. Outlives the job that may be
  // writing there.
  struct Scratch {
    std::vector<std::filesystem::path> folders;
    ~Scratch();
  };

  QWidget& window_;
  Scratch scratch_;
  Background job_;
  std::shared_ptr<Demo> demo_; // not read while a step runs
  std::filesystem::path folder_;
  int begun_ = 0; // sequences
  QStackedWidget* cells_ = new QStackedWidget;
  StepList* steps_ = new StepList;
  QWidget* profile_ = new QWidget;
  QComboBox* material_ = new QComboBox;
  ProfilePlot* plot_ = new ProfilePlot;
  ScanView* view_ = nullptr; // made with the first step
  TextureLibrary library_;
  std::shared_ptr<const FeltTexture> chosen_; // of the library
  bool library_shown_ = false;
  std::optional<Work> work_;
  bool has_texture_ = false;
};

} // namespace patina
