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
    // Opens what is no scene: true if it did. May be empty.
    std::function<bool(const std::filesystem::path&)> elsewhere;
  };
  DocumentController(const Parts& parts, QObject* parent);

  // Whether a person is asked about what is not saved; a script's window has nobody to ask.
  void setAsks(bool asks) { asks_ = asks; }
  bool asks() const { return asks_; }
  void open(const LoadRequest& request);
  void openAsked(const LoadRequest& request); // unless the person would rather keep their edits
  void openDialog(bool adds);
  void cancel(); // what is loaded, else what is edited
  bool close();  // false: a file is still being read, and rested() follows

  QString nameUnderWay() const;
  QStringList recent() const { return recent_.paths(); } // the newest first
  void openFile(const QString& path);                    // asks for what is not saved
  const std::optional<Work>& work() const { return work_; }

 signals:
  void previewed(std::shared_ptr<const patina::TriangleMesh> mesh, const QString& name);
  void opening();   // in the place of what is open; no question stands before it
  void openedNow(); // what was being opened is
  void openAlready();
  void abandoned(); // nothing is being loaded, or not before a question is answered; then, if so:
  void failed(const QString& message);
  void cancelled();
  void changed();
  void said(const patina::Message& message);
  void rested();

 private:
  void connectLoader();
  void take(OpenedEditor& opened);
  void add(const OpenedScene& opened);
  void fail(const QString& message);

  Parts at_;
  SceneLoader loader_;
  RecentFiles recent_;
  std::optional<Work> work_;
  bool asks_ = true, closing_ = false;
};

} // namespace patina
