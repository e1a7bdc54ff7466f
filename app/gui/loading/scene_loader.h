// Opening a scene without holding up the window: behind it, signals back.
#pragma once

#include <functional>
#include <memory>

#include <QObject>
#include <QString>
#include <QStringList>

#include "app/gui/window/background.h"
#include "session/build/session.h"
#include "session/edit/editor.h"
#include "session/store/autosave.h"

namespace patina {

struct LoadRequest {
  std::filesystem::path path; // empty: a preset
  std::string preset{};       // of presets(); empty: the first
  OpenOptions options;
  bool unit_chosen = false; // by a person: no question about the size
  bool adds = false;        // its objects come to those that are open
  bool asks = false;        // only read: readable(), or why not, before anything is given up
  bool recover = false;     // of a workspace that is damaged what can be read
  bool own = true;          // edits go into the folder; false: it is only read
  QString unsaved_name{};   // of what nobody has saved yet, in a folder that does not stay
  std::filesystem::path
      place{};                  // of a scene that a crash left behind, see autosave.h; no path then
  std::function<void()> then{}; // called by the window when it is open, and only then
};

struct Preset;
const Preset& presetOf(const LoadRequest& request); // that has no path

// What was opened, ready to be edited.
struct OpenedEditor {
  std::unique_ptr<Editor> editor;
  std::unique_ptr<Autosave> autosave; // of a scene that a crash left behind
  QStringList warnings;
};

class SceneLoader : public QObject {
  Q_OBJECT
 public:
  // Editors that it makes report to `listener`.
  explicit SceneLoader(Editor::Listener listener, QObject* parent = nullptr);

  // A load that is under way is cancelled; its signals are no longer sent. No call waits.
  void start(const LoadRequest& request);
  void cancel();
  bool busy() const { return jobs_.busy(); }
  bool resting() const { return jobs_.resting(); }
  const LoadRequest& request() const { return request_; }

 signals: // in the thread of this object; those after meshReady end the load
  void progressed(double fraction, const QString& what);
  void meshReady(std::shared_ptr<const patina::TriangleMesh> mesh, const QString& name);
  void ready(std::shared_ptr<patina::OpenedEditor> opened);
  void read(std::shared_ptr<patina::OpenedScene> objects); // instead of ready(), of what adds
  void failed(const QString& message);
  void cancelled();
  void readable();                     // instead of ready(), of what asks
  void needsUnit(double longest_side); // in file units, when millimetres give an odd size
  void needsIso(double low, double high);
  void rested(); // the last thread has ended

 private:
  void run(const LoadRequest& request, Progress& progress, const Background::Deliver& deliver);
  // False if a question ends the load.
  bool readFile(const LoadRequest& request, const Background::Deliver& deliver,
                OpenedScene& opened);
  void openEditor(const LoadRequest& request, OpenedScene opened, OpenedEditor& made,
                  Progress& progress) const;

  Editor::Listener listener_;
  LoadRequest request_;
  Background jobs_;
};

} // namespace patina
