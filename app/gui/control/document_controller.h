// Files and folders of the window: opens, saves and recovers them, with the questions that belong
// to that.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <QMenu>
#include <QObject>

#include "app/gui/control/edit_controller.h"
#include "app/gui/loading/recent_files.h"
#include "app/gui/loading/recover_bar.h"
#include "app/gui/loading/scene_loader.h"
#include "app/gui/panels/message_panel.h"
#include "app/gui/window/window_state.h"

namespace patina {

class DocumentController : public QObject {
  Q_OBJECT
 public:
  struct Parts {
    QWidget& window; // which questions are asked over, and files are dropped on
    RecoverBar& recover;
    QMenu& recent;
    EditController& edits;
  };
  DocumentController(const Parts& parts, QObject* parent);

  // Whether a person is asked about what is not saved; a script's window has nobody to ask.
  void setAsks(bool asks) { asks_ = asks; }
  bool asks() const { return asks_; }
  void open(const LoadRequest& request);
  void openAsked(const LoadRequest& request); // unless the person would rather keep their edits
  void openDialog(bool adds);
  // What is up in the mesh files that a person opens from now on, in later sessions too.
  UpAxis up() const { return up_; }
  void setUp(UpAxis up);
  bool save();                        // false: nothing was saved
  bool saveDialog();                  // the same, into a folder that is asked for
  void saveTo(const QString& folder); // events go on until it is there; throws Error
  bool settleEdits();                 // saved or dropped; false: the person goes on
  void cancel();                      // what is loaded, else what is edited
  void offerRecovery();               // of what a crash has left behind, if anything
  bool close();                       // false: a file is still being read, and rested() follows

  QString name() const;         // of what is open; empty: nothing is
  QString nameUnderWay() const; // of what is being opened
  const std::optional<Work>& work() const { return work_; }
  std::optional<std::filesystem::path> leftBehind() const;

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
  void connectRecovery();
  void take(OpenedEditor& opened);
  void add(const OpenedScene& opened);
  void abandon();
  void fail(const QString& message);
  LoadRequest requestFor(const QString& path) const;
  void discard(); // what was edited since it was saved
  bool trySaving(const std::function<void()>& save, const QString& where, const QString& advice);

  Parts at_;
  SceneLoader loader_;
  RecentFiles recent_;
  QString name_;
  std::optional<Work> work_;
  std::vector<std::filesystem::path> left_behind_; // what is offered comes first
  UpAxis up_;
  bool asks_ = true, closing_ = false;
};

} // namespace patina
