// Opens and saves the path of the desk Align: files, and scans of the scene.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <QFileDialog>

#include "app/gui/aligning/align_panel.h"
#include "app/gui/aligning/alignment.h"
#include "app/gui/panels/message_panel.h"
#include "scene/scene.h"

namespace patina {

// A path with its pose on a mesh, as a scan of the scene has it.
struct AlignedPath {
  std::vector<PathSample> path;
  std::optional<Pose> mesh_from_path; // nullopt: not aligned yet.
  double tip_radius = 0;              // Radius of the probe's tip [m].
};
// Reads the path of a scan that has one. Throws FileError.
AlignedPath alignedPathOf(const SceneScan& scan);

// Returns a scan of this name with the path and its pose.
SceneScan alignedScan(const std::string& name, const Alignment& alignment);
// Merges `aligned` into `known`, which may be nullptr. Throws Error if that has another path.
SceneScan withAlignment(const SceneScan* known, const SceneScan& aligned);

class AlignFiles : public QObject {
  Q_OBJECT
 public:
  // Serves the panel's requests; dialogs belong to the window.
  AlignFiles(QWidget& window, const Alignment& alignment, AlignPanel& panel);

  void setScene(std::shared_ptr<const Scene> scene) { // The scene whose paths can be chosen.
    scene_ = std::move(scene);
    panel_.setScans(scansWithPath());
  }
  void openPath(const std::filesystem::path& file);
  void openScan(const QString& name);
  void openFirstScan() { // Opens the scene's first scan that has a path, if there is one.
    if (const QStringList names = scansWithPath(); !names.isEmpty()) openScan(names.front());
  }
  void store(const QString& name);
  bool confirmDiscard(const QString& what); // Asks to save or discard; false: cancelled.
  using Change = std::function<SceneScan(const SceneScan* now)>; // See SceneScans.

 signals:
  void opened(const QString& name, const patina::AlignedPath& path);
  void notified(const patina::Message& message);
  // `stored` is called only after the scene has been changed.
  void storeRequested(const std::string& name, const patina::AlignFiles::Change& change,
                      const std::function<void()>& stored);
  void saved(const patina::Pose& pose); // Saved to a file or to the scene.

 private:
  void open(const QString& name, const std::function<AlignedPath()>& read);
  QStringList scansWithPath() const;
  void openDialog();
  QFileDialog* keepDialog();
  void save(const std::filesystem::path& file);

  QWidget& window_;
  const Alignment& alignment_;
  AlignPanel& panel_;
  std::shared_ptr<const Scene> scene_;
};

} // namespace patina
