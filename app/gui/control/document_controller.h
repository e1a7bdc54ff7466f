// Opens files and folders in the window, with the dialogs that this needs.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include <QMenu>
#include <QObject>
#include <QStringList>

#include "app/gui/control/edit_controller.h"
#include "app/gui/loading/scene_loader.h"
#include "app/gui/panels/message_panel.h"
#include "app/gui/state/window_state.h"
#include "app/gui/toolkit/background.h"

namespace patina {

// Saves what is open, with the dialogs that this needs.
class SaveController : public QObject {
  Q_OBJECT
 public:
  SaveController(QWidget& window, EditController& edits, QObject* parent)
      : QObject(parent), window_(window), edits_(edits) {}

  QString name() const;                               // Name of the scene; empty: none.
  void setName(const QString& name) { name_ = name; } // Used until the scene has a folder.
  bool save();                                        // False: nothing was saved.
  bool saveDialog();                    // The same, into a folder that the user chooses.
  void exportDialog();                  // For ParaView, into a folder that the user chooses.
  void exportTo(const QString& folder); // Queued after running exports.
  // Asks for a .ply, .obj or .stl file; with_relief: painted relief becomes part of the surface.
  void exportMeshDialog(bool with_relief);
  void saveTo(const QString& folder); // Processes events until it is saved. Throws Error.
  // Other unsaved state, which is saved or discarded before the scene's own edits.
  struct UnsavedGuard {
    std::function<bool()> is_saved = [] { return true; };
    std::function<bool()> confirm = [] { return true; }; // False: cancelled.
  };
  void setUnsavedGuard(UnsavedGuard guard) { unsaved_guard_ = std::move(guard); }
  bool hasUnsaved() const {
    return edits_.unsaved() || edits_.thread().busy() || !unsaved_guard_.is_saved();
  }
  bool confirmEdits(); // Asks to save or discard; false: cancelled.

 signals:
  void notified(const patina::Message& message);
  void saved(const QString& folder); // In a new folder.

 private:
  void discard(); // Discards the edits since the last save.
  bool trySaving(const std::function<void()>& save, const QString& where, const QString& advice);
  // Runs on another thread, and returns what is said at the end. Throws std::exception.
  using Export = std::function<Message(Progress& progress)>;
  void queueExport(const QString& where, const QString& advice, Export run);
  void exportNext();

  QWidget& window_; // Parent of dialogs.
  EditController& edits_;
  QString name_;
  UnsavedGuard unsaved_guard_;
  Background exports_{this};
  struct WaitingExport {
    QString where, advice;
    Export run;
  };
  std::deque<WaitingExport> waiting_;
};

// The files that were opened last, stored between sessions.
class RecentFiles : public QObject {
  Q_OBJECT
 public:
  RecentFiles(QMenu& menu, QObject* parent) : QObject(parent), menu_(menu) { rebuild(); }
  void add(const QString& path);
  QStringList paths() const;

 signals:
  void chosen(const QString& path);

 private:
  void rebuild();
  QMenu& menu_;
};

class DocumentController : public QObject {
  Q_OBJECT
 public:
  struct Parts {
    QWidget& window; // Parent of dialogs; accepts dropped files.
    QMenu& recent;
    EditController& edits;
    SaveController& saving;
    // Opens files that are no scene; returns true if it did. May be empty.
    std::function<bool(const std::filesystem::path&)> open_other;
  };
  DocumentController(const Parts& parts, QObject* parent);

  // False for scripted windows: no questions about unsaved edits.
  void setInteractive(bool on) { interactive_ = on; }
  bool isInteractive() const { return interactive_; }
  void open(const LoadRequest& request);
  void openRequested(const LoadRequest& request); // Unless the user cancels to keep unsaved edits.
  void openDialog(bool adds);
  void layPictureDialog(std::size_t object); // Asks for a picture and how to lay it.
  void unitDialog(std::size_t object);       // Asks how its file should have been read.
  void cancel();                             // Cancels loading, or else the running edit.
  void close() { // Cancels loading; a thread that reads a file may go on.
    closing_ = true;
    loader_.cancel();
  }

  QString nameUnderWay() const;
  // Why edits of the scene do not reach a folder, as it is open elsewhere or on a full disk; empty:
  // they do.
  QString storageProblem() const;
  QStringList recent() const { return recent_.paths(); } // The newest is first.
  void openFile(const QString& path);                    // Confirms unsaved edits first.
  const std::optional<TaskProgress>& work() const { return work_; }

 signals:
  void previewed(std::shared_ptr<const patina::TriangleMesh> mesh, const QString& name);
  void opening();      // Replaces what is open, after all questions.
  void loadFinished(); // The requested scene is open.
  void alreadyOpen();
  // No load is running, or it waits for an answer. May be followed by:
  void abandoned();
  void failed(const QString& message);
  void cancelled();
  void changed();
  void notified(const patina::Message& message);

 private:
  void connectLoader();
  void take(OpenedEditor& opened);
  void add(const OpenedScene& opened);
  void fail(const QString& message);

  Parts at_;
  SceneLoader loader_;
  RecentFiles recent_;
  std::optional<TaskProgress> work_;
  QString read_only_; // Why the folder from which the scene came takes no edits.
  bool interactive_ = true, closing_ = false;
};

} // namespace patina
