// Opens a scene in the background and reports by signals.
#pragma once

#include <functional>
#include <memory>

#include <QObject>
#include <QString>
#include <QStringList>

#include "app/gui/toolkit/background.h"
#include "session/edit/editor.h"
#include "session/open/session.h"
#include "session/store/autosave.h"

namespace patina {

struct LoadRequest {
  std::filesystem::path path{}; // Empty: a preset.
  std::string preset{};         // A name of presets(); empty: the first.
  OpenOptions options{};
  bool unit_chosen = false; // The user has chosen it.
  bool adds = false;        // Adds its objects to the open scene.
  bool check_only = false;  // Only checks: readable() or failed(). The open scene stays.
  bool recover = false;     // Opens the readable part of a damaged workspace.
  bool own = true;          // Edits are written to the folder; false: read-only.
  QString unsaved_name{};   // Name of a scene in a temporary folder.
  // A scene that a crash has left, see autosave.h; `path` is empty then.
  std::filesystem::path place{};
  std::function<void()> then{}; // Called once the scene is open.
};

struct Preset;
const Preset& presetOf(const LoadRequest& request);

// The opened scene with its editor.
struct OpenedEditor {
  std::unique_ptr<Editor> editor;
  std::unique_ptr<Autosave> autosave; // If a crash has left the scene.
  QStringList warnings;
  QString read_only; // Why edits are not saved in its folder; empty: they are.
};

class SceneLoader : public QObject {
  Q_OBJECT
 public:
  // The new editors report to `listener`.
  explicit SceneLoader(Editor::Listener listener, QObject* parent = nullptr);

  // Cancels a running load and suppresses its signals. No call waits.
  void start(const LoadRequest& request);
  void cancel();
  bool busy() const { return jobs_.busy(); }
  bool isIdle() const { return jobs_.isIdle(); }
  const LoadRequest& request() const { return request_; }

 signals: // In this object's thread. Those after meshReady end the load.
  void progressed(double fraction, const QString& what);
  void meshReady(std::shared_ptr<const patina::TriangleMesh> mesh, const QString& name);
  void ready(std::shared_ptr<patina::OpenedEditor> opened);
  void read(std::shared_ptr<patina::OpenedScene> objects); // Instead of ready(), if request.adds.
  void failed(const QString& message);
  void cancelled();
  void readable(); // Instead of ready(), if request.check_only.
  // Longest side in file units, if millimetres give an unlikely size.
  void needsUnit(double longest_side);
  void needsIso(double low, double high);

 private:
  void run(const LoadRequest& request, Progress& progress, const Background::Post& post);
  // Returns false if a question ends the load.
  bool readFile(const LoadRequest& request, const Background::Post& post, OpenedScene& opened);
  void openEditor(const LoadRequest& request, OpenedScene opened, OpenedEditor& made,
                  Progress& progress) const;

  Editor::Listener listener_;
  LoadRequest request_;
  Background jobs_{this};
};

} // namespace patina
