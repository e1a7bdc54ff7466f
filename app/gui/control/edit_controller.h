// Edits what is open: asks the edit thread, hears what it did, and keeps the panels as the scene
// is.
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
#include "app/gui/window/window_state.h"
#include "session/edit/edit_thread.h"

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
  using Publish = std::function<void(const CompiledScene&)>; // called on the edit thread
  EditController(const Parts& parts, Publish publish, QObject* parent);

  EditThread& thread() { return thread_; }
  const std::shared_ptr<const CompiledScene>& scene() const { return scene_; } // null: none
  const EditStatus& status() const { return status_; }
  std::optional<Work> work() const;         // that takes its time
  bool unsaved() const { return unsaved_; } // also what was not asked for yet
  bool hasRelief() const { return has_relief_; }

  // Asks for the values that panels have sent since the last time; of every window tick.
  void tryValues();
  void addObjects(const std::vector<SceneObject>& objects, EditThread::Done done);
  void setTool(const ToolChoice& choice);
  void showAgain(); // what is open, in the place of a preview
  // Events go on until what is asked for is done; throws Error or Cancelled.
  void waitFor(const std::function<void(EditThread::Done)>& ask);
  void settle(); // waits for all that was asked for

 signals:
  void sceneChanged(const patina::SceneChange& change);
  void changed();
  void refused(const QString& problem); // the scene is as it was before

 private:
  void takeEvents();
  void takeScene(std::shared_ptr<const CompiledScene> scene, bool anew);
  void showScene(const SceneChange& change);
  void syncPanels();
  void showRelief();
  void applyObjects(); // as the panel has them
  void setUnsaved(bool unsaved);

  Parts at_;
  std::shared_ptr<const CompiledScene> scene_;
  EditStatus status_;
  std::optional<EditProgress> progress_;
  bool unsaved_ = false, has_relief_ = false, paints_relief_ = false;
  bool values_edited_ = false;               // and not yet asked for
  int values_asked_ = 0, objects_asked_ = 0; // and not yet answered
  EditThread thread_;                        // last: it reports to all of these
};

} // namespace patina
