// The desk on which a person aligns a path with the mesh: four views, six pose values, three point
// pairs, a fit from the present pose. It shows the distances live.
#pragma once

#include <map>
#include <optional>
#include <utility>

#include <QTimer>

#include "app/gui/aligning/align_central_views.h"
#include "app/gui/aligning/align_files.h"
#include "app/gui/aligning/align_panel.h"
#include "app/gui/state/window_state.h"
#include "scan/scan_advice.h"

namespace patina {

class AlignDesk : public QObject {
  Q_OBJECT
 public:
  explicit AlignDesk(QWidget& window);

  AlignCentralViews* centralViews() const { return central_views_; }
  std::map<Panel, QWidget*> panels() const;

  AlignFiles& files() { return files_; }
  const Alignment& alignment() const { return alignment_; }
  const QString& name() const { return name_; }
  const std::optional<TaskProgress>& work() const { return work_; }

  // The path may include samples in the air. Fewer than three in contact change nothing.
  void setPath(const QString& name, const AlignedPath& aligned);
  // The same; is_interactive: confirms first if an unsaved placement would be lost.
  void takePath(const QString& name, const AlignedPath& aligned, bool is_interactive);
  // nullptr: no scene is open. Opens the scene's first path once the desk is visible.
  void setSceneMesh(std::shared_ptr<const TriangleMesh> mesh);
  void changeSceneMesh(std::shared_ptr<const TriangleMesh> mesh); // Keeps the path's pose.
  bool isSaved() const { // True if the pose is saved, or if the path was not moved.
    return !alignment_.isReady() || alignment_.pose().isApprox(saved_pose_, 1e-12);
  }
  bool confirmPlacement();                       // Asks to save or discard; false: cancelled.
  void setColors(const ColorScale& error);       // Colours of path and error map.
  std::optional<ValueRange> shownRange() const { // Range of these colours [m]; nullopt: none.
    const auto range = central_views_->valueRange();
    return range ? std::optional(ValueRange{1e-3 * range->low, 1e-3 * range->high}) : std::nullopt;
  }
  void registerFromHere(); // Starts a fit from the present pose.
  void cancel();
  void undo() { stepTo(&Alignment::undo); }
  void redo() { stepTo(&Alignment::redo); }
  void refresh(); // Called on each tick of the window.

 signals:
  void changed();
  void fitted(bool is_certain); // A fit has ended; false also after an error or a cancel.
  void notified(const patina::Message& message);
  void underPointer(const QString& words); // Empty: nothing.

 private:
  void begin();                // Resets everything for another path or mesh.
  void showNew();              // Shows an alignment about which nothing is computed yet.
  void move(const Pose& pose); // Moves the path during a drag.
  // Commits the move as a step; nullopt: it was moved by hand.
  void finishMove(std::optional<Registration> fit = {});
  void stepTo(bool (Alignment::*step)());
  void showPlace();
  void draw();
  void drawMap();
  const ScanAdvice* advice() const; // nullptr: not shown, or not known at this pose
  void setPicking(bool on);
  void pick(const Ray& sight, double reach);
  QString probeWords(const Ray& sight, double reach) const;

  Background fit_job_;
  Alignment alignment_;
  QString name_;
  AlignCentralViews* central_views_ = new AlignCentralViews;
  AlignPanel* panel_ = new AlignPanel;
  PointPicking picking_;
  CostProfileJob cost_profile_;
  AlignFiles files_;
  QTimer pause_timer_;
  std::optional<std::pair<QString, AlignedPath>> offered_; // Waits for the answer to a question.
  ColorScale colors_;
  std::optional<ScanAdvice> advice_; // after the last fit
  Pose advised_pose_ = Pose::Identity();
  double reach_ = 1;                   // Range of the sliders [m].
  Pose drag_start_ = Pose::Identity(); // Pose at the start of the drag.
  // Last pose saved to a file or the workspace, or the first one.
  Pose saved_pose_ = Pose::Identity();
  bool stale_ = false;  // True if moved since the last drawing.
  bool unseen_ = false; // True if this scene was not shown here yet.
  std::optional<TaskProgress> work_;
};

} // namespace patina
