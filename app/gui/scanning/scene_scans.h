// Lists the scans of the scene, and adds, opens or removes them. Each change is an edit with undo.
#pragma once

#include <QListWidget>
#include <QPushButton>
#include <QWidget>

#include "app/gui/panels/message_panel.h"
#include "session/edit/edit_thread.h"

namespace patina {

class SceneScans : public QWidget {
  Q_OBJECT
 public:
  explicit SceneScans(QWidget* parent = nullptr);

  void setEdits(EditThread& edits) { edits_ = &edits; }
  void setScene(std::shared_ptr<const Scene> scene) { // nullptr: none is open.
    scene_ = std::move(scene);
    refresh();
  }
  void setOpen(bool scan) { // True if a scan is open that could be added.
    scan_ = scan;
    refresh();
  }
  // The scan after each step; each change becomes an edit.
  void put(const std::vector<SceneScan>& steps);
  // Computes the new scan from the scene's scan at the time of the edit; nullptr: there is none.
  // Throws Error with the reason if it cannot. `done` is called when the scene has changed.
  using Change = std::function<SceneScan(const SceneScan* now)>;
  void change(const std::string& name, const Change& change, std::function<void()> done = {});
  const Scene* scene() const { return scene_.get(); }

 signals:
  void putRequested();
  void openRequested(const patina::SceneScan& scan);
  void failed(const QString& problem);
  void notified(const patina::Message& message);

 private:
  SceneScan ask(const std::string& name, const SceneScan* before, const Change& change,
                std::function<void()> done = {});
  void reportLost(const SceneScan* before, const SceneScan& after);
  const SceneScan* chosen() const;
  void apply(const std::string& what, std::function<Scene(const Scene&)> edit,
             std::function<void()> done = {});
  void refresh();

  EditThread* edits_ = nullptr;
  std::shared_ptr<const Scene> scene_;
  QListWidget* list_;
  QPushButton *put_, *open_, *remove_;
  bool scan_ = false;
};

} // namespace patina
