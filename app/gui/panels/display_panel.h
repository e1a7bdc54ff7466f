// What the 3D view shows, with the slice's and the iso-surface's own values while they are shown.
#pragma once

#include <map>

#include <QCheckBox>
#include <QComboBox>
#include <QGroupBox>
#include <QLabel>

#include "app/gui/panels/value_row.h"
#include "visualization/view/scene_view.h"

namespace patina {

// How the clip plane is to lie: across an axis, facing the viewer, or the other way round.
enum class ClipTurn { x, y, z, viewer, flip };

class DisplayPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit DisplayPanel(QWidget* parent = nullptr);

  void setField(const SurfaceField* field); // nullptr: the mesh alone can be shown
  void setBand(bool has_band);              // whether the scene has an offset or a magnet
  // How far the map of the layer stability is, or what it says; empty = nothing to say.
  void setStabilityNote(const QString& words);
  void setShown(Layer layer, bool on); // sends layerToggled if it changes
  bool shown(Layer layer) const;
  QCheckBox& clip() { return *clip_; } // on: there is a clip plane
  QString caption(Layer layer) const;  // of its box; must have one

 signals:
  void layerToggled(patina::Layer layer, bool on);
  void sliceMoved(const patina::SlicePlace& place);
  void isoMoved(double iso); // [m]
  void clipTurned(patina::ClipTurn turn);

 private:
  void arrange();
  void addClip(QLayout& column);

  std::map<Layer, QCheckBox*> boxes_;
  QCheckBox* clip_;
  QWidget* clip_card_;
  QWidget* slice_card_;
  QComboBox* axis_;
  ValueRow* position_;
  QLabel* stability_note_;
  QWidget* iso_card_;
  ValueRow* iso_ = nullptr;
  SlicePlace slice_;
  bool has_field_ = false, has_band_ = false;
};

} // namespace patina
