// Sends edits of the open scene to the edit thread, receives the results and updates the panels.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <QObject>

#include "app/gui/control/scene_change.h"
#include "app/gui/painting/relief_panel.h"
#include "app/gui/panels/device_panel.h"
#include "app/gui/panels/haptics_panel.h"
#include "app/gui/panels/history_panel.h"
#include "app/gui/panels/object_list.h"
#include "app/gui/state/window_state.h"
#include "session/edit/edit_thread.h"
#include "session/edit/lay_picture.h"
#include "session/edit/reread_object.h"

namespace patina {

class EditController : public QObject {
  Q_OBJECT
 public:
  struct Parts {
    HapticsPanel& haptics;
    DevicePanel& device;
    ObjectList& objects;
    ReliefPanel& relief;
    HistoryPanel& history;
  };
  using Publish = std::function<void(const CompiledScene&)>;   // called on the edit thread
  using Ticks = std::function<void(std::vector<ToolSample>&)>; // the same; see EditThread::Spec
  EditController(const Parts& parts, Publish publish, Ticks ticks, QObject* parent);

  EditThread& thread() { return thread_; }
  const std::shared_ptr<const CompiledScene>& scene() const { return scene_; } // nullptr: none.
  const EditStatus& status() const { return status_; }
  std::optional<TaskProgress> work() const; // Progress of an edit that takes long.
  bool unsaved() const { return unsaved_; } // Includes edits that are not sent yet.
  // Steps that undo() can take back, with values that are no edit yet.
  std::size_t undoable() const {
    return status_.done + (values_edited_ || values_pending_ > 0 || status_.previews ? 1 : 0);
  }
  void undo();
  bool hasRelief() const { return has_relief_; }

  // Sends the values that panels have changed; called on each tick of the window.
  void previewValues();
  void changeValues(std::function<void(Scene&)> change); // One step of the history.
  void changeLooks(std::function<void(Scene&)> change);  // Colours or slices, at once.
  void addObjects(const std::vector<SceneObject>& objects, EditThread::Done done);
  void layPicture(const std::filesystem::path& file, const std::string& object, PictureEdit edit,
                  EditThread::Done done);
  // `mesh`: that of the object when this was asked; another one is refused.
  void rereadObject(const std::string& object, std::shared_ptr<const TriangleMesh> mesh,
                    MeshUnit was, MeshUnit now, UpAxis up, EditThread::Done done);
  void setTool(const ToolChoice& choice) {
    paints_relief_ = choice == ToolChoice{InteractionMode::paint, Tool::relief};
    showRelief();
  }
  void showAgain() { // Shows the open scene again after a preview.
    showScene({scene_, SceneChange::Step::again});
  }
  // Processes events until the edit is done. Throws Error or Cancelled.
  void waitFor(const std::function<void(EditThread::Done)>& ask);
  void waitForEdits(); // Waits for all edits that were sent.

 signals:
  void sceneChanged(const patina::SceneChange& change);
  void changed();
  void refused(const QString& problem); // The scene is unchanged.
  void looksDone();                     // Once for each changeLooks().

 private:
  void takeEvents();
  void takeScene(std::shared_ptr<const CompiledScene> scene, bool is_new);
  void showScene(const SceneChange& change);
  void syncPanels();
  void showRelief() {
    if (scene_ && (has_relief_ || paints_relief_)) at_.relief.show(scene_);
  }
  void applyObjects(); // Sends the panel's objects.
  void setUnsaved(bool unsaved) {
    unsaved_ = unsaved;
    emit changed();
  }

  Parts at_;
  std::shared_ptr<const CompiledScene> scene_;
  EditStatus status_;
  std::optional<EditProgress> progress_;
  bool unsaved_ = false, has_relief_ = false, paints_relief_ = false;
  bool values_edited_ = false;                   // Changed and not sent yet.
  int values_pending_ = 0, objects_pending_ = 0; // Sent and not answered yet.
  EditThread thread_;                            // Must be last: it reports to the members above.
};

} // namespace patina
