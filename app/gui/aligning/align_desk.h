// The desk on which a path is laid onto the mesh by hand: four views at once, six values, three
// points, a fit from there; what it is off, live.
#pragma once

#include <map>
#include <optional>
#include <utility>

#include <QTimer>

#include "app/gui/aligning/align_cells.h"
#include "app/gui/aligning/align_files.h"
#include "app/gui/aligning/align_panel.h"
#include "app/gui/aligning/around_place.h"
#include "app/gui/aligning/point_picking.h"
#include "app/gui/window/window_state.h"

namespace patina {

class AlignDesk : public QObject {
  Q_OBJECT
 public:
  explicit AlignDesk(QWidget& window); // to which it belongs

  // To be laid out by the window.
  AlignCells* cells() const { return cells_; }
  std::map<Panel, QWidget*> panels() const;

  AlignFiles& files() { return files_; }
  const Alignment& alignment() const { return alignment_; }
  const QString& name() const { return name_; } // of the path
  const std::optional<Work>& work() const { return work_; }

  // Not yet told by contact. A path with fewer than three samples in contact changes nothing.
  void setPath(const QString& name, const AlignedPath& aligned);
  void takePath(const QString& name, const AlignedPath& aligned, bool asks); // for a place unkept
  // nullptr: no scene is open. Where no path is laid yet its first scan's is, once it is seen.
  void setSceneMesh(std::shared_ptr<const TriangleMesh> mesh);
  void changeSceneMesh(std::shared_ptr<const TriangleMesh> mesh); // the path stays where it lies
  bool isKept() const;     // where the path lies, or nobody has laid it there
  bool settlePlacement();  // kept or given up; false: the person goes on
  void registerFromHere(); // from where a hand has put the path, or from nowhere
  void cancel();
  void undo();
  void redo();
  void refresh(); // of every tick of the window

 signals:
  void changed();
  void fitted(bool is_certain); // a fit has ended; false: by an error or a cancel, too
  void said(const patina::Message& message);

 private:
  void begin();                                      // another path or mesh
  void showAnew();                                   // of which nothing is known yet
  void move(const Pose& pose);                       // while a hand moves it
  void settle(std::optional<Registration> fit = {}); // it has; nullopt: a hand has
  void showPlace();                                  // of the step that is done
  void draw();
  void drawMap();
  void setPicking(bool on);
  void pick(const Ray& sight, double reach);

  Background fit_job_;
  Alignment alignment_;
  QString name_;
  AlignCells* cells_ = new AlignCells;
  AlignPanel* panel_ = new AlignPanel;
  PointPicking picking_;
  AroundPlace around_;
  AlignFiles files_;
  QTimer settle_;
  std::optional<std::pair<QString, AlignedPath>> offered_; // while a question stands before it
  double reach_ = 1;                                       // of the sliders [m]
  Pose held_ = Pose::Identity();                           // as it was when a drag began
  Pose kept_ = Pose::Identity(); // in a file or in the workspace, or the first
  bool stale_ = false;           // moved since it was drawn
  bool unseen_ = false;          // the scene, here
  std::optional<Work> work_;
};

} // namespace patina
