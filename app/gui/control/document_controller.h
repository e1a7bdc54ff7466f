// Opens files and folders in the window, with the questions that belong to that.
#pragma once

#include <optional>

#include <QMenu>
#include <QObject>

#include "app/gui/control/save_controller.h"
#include "app/gui/loading/recent_files.h"
#include "app/gui/loading/scene_loader.h"
#include "app/gui/window/window_state.h"

namespace patina {

class DocumentController : public QObject {
  Q_OBJECT
 public:
  struct Parts {
    QWidget& window; // which questions are asked over, and files are dropped on
    QMenu& recent;
    EditController& edits;
    SaveController& saving;
  };
  DocumentController(const Parts& parts, QObject* parent);

  // Whether a person is asked about what is not saved; a script's window has nobody to ask.
  void setAsks(bool asks) { asks_ = asks; }
  bool asks() const { return asks_; }
  // What is no scene, and is opened by someone else: true if it was.
  void setElsewhere(std::function<bool(const std::filesystem::path&)> opens) {
    elsewhere_ = std::move(opens);
  }
  void open(const LoadRequest& request);
  void openAsked(const LoadRequest& request); // unless the person would rather keep their edits
  void openDialog(bool adds);
  // What is up in the mesh files that a person opens from now on, in later sessions too.
  UpAxis up() const { return up_; }
  void setUp(UpAxis up);
  void cancel(); // what is loaded, else what is edited
  bool close();  // false: a file is still being read, and rested() follows

  QString nameUnderWay() const; // of what is being opened
  const std::optional<Work>& work() const { return work_; }

 signals:
  void previewed(std::shared_ptr<const patina::TriangleMesh> mesh, const QString& name);
  void openAlready();
  void abandoned(); // a load came to nothing; then, if so:
  void failed(const QString& message);
  void cancelled();
  void changed();
  void said(const patina::Message& message);
  void rested();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override; // what is dropped on the window

 private:
  void connectLoader();
  void take(OpenedEditor& opened);
  void add(const OpenedScene& opened);
  void abandon();
  void fail(const QString& message);
  LoadRequest requestFor(const QString& path) const;
  bool opensElsewhere(const LoadRequest& request);

  Parts at_;
  std::function<bool(const std::filesystem::path&)> elsewhere_;
  SceneLoader loader_;
  RecentFiles recent_;
  std::optional<Work> work_;
  UpAxis up_;
  bool asks_ = true, closing_ = false;
};

} // namespace patina
