// The scans of the scene: which there are, and what puts one in, opens it or takes it out. Each is
// an edit like any other.
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
  void setScene(std::shared_ptr<const Scene> scene); // nullptr: none is open
  void setOpen(bool scan);                           // one is, that could be put in
  // Each as it is after one more step, which becomes an edit if it changes something.
  void put(const std::vector<SceneScan>& steps);
  // What the scene's scan becomes, of what it is when the edit's turn comes; nullptr: there is
  // none. Throws Error why it becomes nothing. `done` is called when it is so in the scene.
  using Change = std::function<SceneScan(const SceneScan* now)>;
  void change(const std::string& name, const Change& change, std::function<void()> done = {});
  const Scene* scene() const { return scene_.get(); }

 signals:
  void putAsked();
  void openAsked(const patina::SceneScan& scan);
  void failed(const QString& problem);
  void said(const patina::Message& message);

 private:
  SceneScan ask(const std::string& name, const SceneScan* before, const Change& change,
                std::function<void()> done = {});
  void tellLost(const SceneScan* before, const SceneScan& after);
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
