// Lists the things of the 3D view: which are shown, and the values of the selected one.
#pragma once

#include <map>
#include <optional>
#include <string>

#include <QGroupBox>
#include <QLineEdit>
#include <QListWidget>
#include <QToolButton>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/value_row.h"
#include "visualization/view/scene_view.h"

namespace patina {

// Pose of the clip plane: normal to an axis, facing the viewer, or reversed.
enum class ClipTurn { x, y, z, viewer, flip };

// A thing is a layer's name, "clip", "paint", or "slice2" or "slice3" for further slices.
class DisplayPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit DisplayPanel(QWidget* parent = nullptr);

  void setField(const SurfaceField* field); // nullptr: only the mesh can be shown.
  void setBand(bool has_band) { setThere(band_there_, has_band); } // Offset or magnet.
  void setPaint(bool has_paint); // Painted objects; selects the paint when it comes.
  // Progress or result of the stability map; empty: none.
  void setStabilityNote(const QString& words) { say(stability_note_, words); }
  // Adds widgets below the list that are visible while the thing is selected.
  void addValues(const std::string& thing, QWidget* values);

  void setShown(const std::string& thing, bool on); // Sends shownChanged if it changes.
  bool isShown(const std::string& thing) const;
  void select(const std::string& thing); // No effect without its row.
  std::string selected() const;
  QString caption(const std::string& thing) const { return rows_.at(thing)->text(); }
  void setSlices(const Slices& slices); // Sends no signal.
  const Slices& slices() const { return slices_; }
  std::size_t slice() const { return slice_; } // The slice whose values the card has.
  void moveSlice(const SlicePosition& place);  // Moves that slice.
  // While checked, a drag in the view draws the line of a profile.
  QToolButton& lineProfile() { return *line_profile_; }

 signals:
  void shownChanged(const std::string& thing, bool on);
  void selectionChanged();
  void slicesChanged();
  void sliceFacing();         // Requests the plane that faces the viewer.
  void sliceHandled(bool on); // Shows the slice's handle or hides it.
  void histogramRequested();
  void isoMoved(double iso); // [m]
  void clipTurned(patina::ClipTurn turn);

 private:
  void setThere(bool& is_there, bool now) {
    is_there = now;
    arrange();
  }
  void arrange();
  QVBoxLayout* addCard(const char* thing);
  void addClip();
  void addSlice();
  SlicePosition place() const { return slices_[slice_].value_or(SlicePosition{}); }
  void showSlice();
  // The range depends on direction and field; nullopt: no field, no row.
  void makePositionRow(const std::optional<ValueRange>& range);

  QListWidget* list_;
  std::map<std::string, QListWidgetItem*> rows_;
  std::map<std::string, QWidget*> values_; // Only rows with values have an entry.
  QLineEdit* direction_ = nullptr;
  QToolButton* line_profile_ = nullptr;
  ValueRow* position_ = nullptr;
  QLabel* stability_note_ = nullptr;
  ValueRow* iso_ = nullptr;
  double iso_reach_ = 0; // [m]
  Slices slices_;
  std::size_t slice_ = 0;
  std::optional<ValueRange> position_range_; // [m]
  std::optional<FieldGrid> grid_;            // nullopt: no field.
  bool band_there_ = false, paint_there_ = false;
};

} // namespace patina
