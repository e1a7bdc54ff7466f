// Chooses the layers of the 3D view, and the values of the slice and the iso-surface.
#pragma once

#include <map>
#include <optional>

#include <QCheckBox>
#include <QGroupBox>
#include <QLineEdit>
#include <QToolButton>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/value_row.h"
#include "visualization/view/scene_view.h"

namespace patina {

// Pose of the clip plane: normal to an axis, facing the viewer, or reversed.
enum class ClipTurn { x, y, z, viewer, flip };

class DisplayPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit DisplayPanel(QWidget* parent = nullptr);

  void setField(const SurfaceField* field); // nullptr: only the mesh can be shown.
  void setBand(bool has_band) {             // True if the scene has an offset or a magnet.
    has_band_ = has_band;
    arrange();
  }
  // Progress or result of the stability map; empty: none.
  void setStabilityNote(const QString& words) { say(stability_note_, words); }
  void setShown(Layer layer, bool on); // Sends layerToggled if it changes.
  bool shown(Layer layer) const;
  QCheckBox& clip() { return *clip_; }       // Checked while there is a clip plane.
  void setSlice(const SlicePosition& place); // Sends no signal.
  // While checked, a drag in the view draws the line of a profile.
  QToolButton& lineProfile() { return *line_profile_; }
  // Caption of the layer's box, which must exist.
  QString caption(Layer layer) const { return boxes_.at(layer)->text(); }

 signals:
  void layerToggled(patina::Layer layer, bool on);
  void sliceMoved(const patina::SlicePosition& place);
  void sliceFacing();         // Requests the plane that faces the viewer.
  void sliceHandled(bool on); // Shows the slice's handle or hides it.
  void histogramRequested();
  void isoMoved(double iso); // [m]
  void clipTurned(patina::ClipTurn turn);

 private:
  void arrange();
  void addClip(QLayout& column);
  void addSlice(QLayout& column);
  void moveSlice(const SlicePosition& place);
  void showSlice();
  // The range depends on direction and field; nullopt: no field, no row.
  void makePositionRow(const std::optional<ValueRange>& range);

  std::map<Layer, QCheckBox*> boxes_;
  QCheckBox* clip_;
  QWidget* clip_card_;
  QWidget* slice_card_;
  QLineEdit* direction_;
  QToolButton* line_profile_;
  ValueRow* position_ = nullptr;
  QLabel* stability_note_;
  QWidget* iso_card_;
  ValueRow* iso_ = nullptr;
  SlicePosition slice_;
  std::optional<ValueRange> position_range_; // [m]
  std::optional<FieldGrid> grid_;            // nullopt: no field.
  bool has_band_ = false;
};

} // namespace patina
