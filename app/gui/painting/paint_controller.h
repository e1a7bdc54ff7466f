// Painting in the window: the tool that is chosen, its brush, and the hand that paints with it.
#pragma once

#include <memory>
#include <vector>

#include <QElapsedTimer>
#include <QObject>

#include "app/gui/painting/brush_panel.h"
#include "app/gui/painting/brush_presets.h"
#include "app/gui/painting/stroke_tracker.h"
#include "app/gui/panels/tool_panel.h"
#include "app/gui/widgets/scene_widget.h"
#include "app/gui/window/tool_bar.h"
#include "haptics/servo/tip_servo.h"
#include "session/edit/edit_thread.h"

namespace patina {

// Painting is feeling: the pointer presses the tool onto the surface under it, the servo feels
// that, and where it feels contact the brush paints. All of these outlive it.
class PaintController : public QObject {
  Q_OBJECT
 public:
  struct Parts {
    ToolBar& bar;
    BrushPanel& panel;
    ToolPanel& tool;
    SceneWidget& view;
    TipServo& feel;
    EditThread& edits;
  };
  explicit PaintController(const Parts& parts, QObject* parent = nullptr);

  void setScene(std::shared_ptr<const CompiledScene> scene, bool anew); // null: none
  void feed(const std::vector<ToolSample>& ticks); // of every window tick, be there any or none
  void refresh();                                  // brush cursor and what is under the pointer
  void resizeBrush(double factor);
  void softenBrush(double factor);
  void setForce(double newtons); // with which the mouse presses the tool on

 signals:
  void chosen(const patina::ToolChoice& choice);
  void underPointer(const QString& words); // empty: nothing

 private:
  void take(const ToolChoice& choice);
  Brush brush() const { return presets_.brush(tool_); }
  void setBrush(const Brush& brush);
  void pickAt(const Vec3& surface);
  void follow(const Pointed& where);
  void press(const Vec3& surface, double newtons);
  Vec3 lifted() const; // the place over the aim
  void lift();         // there at once
  void escape();       // the stroke is taken back
  void moveTip(const Vec3& target);
  void leapTip(const Vec3& target); // above what it would go through
  void passTip(const Vec3& target); // when it is that event's turn
  std::optional<SurfaceValues> valuesAt(const Vec3& surface, QString* object = nullptr) const;
  bool arrived(const std::vector<ToolSample>& ticks) const;
  void send(const std::vector<StrokePiece>& pieces);
  void showMirror(bool paints);
  void showCursor(const std::optional<Vec3>& surface);
  QString wordsFor(const Vec3& surface) const;

  Parts at_;
  std::shared_ptr<const CompiledScene> scene_;
  BrushPresets presets_;
  Tool tool_ = Tool::color; // of the brush, also while something else is chosen
  StrokeTracker tracker_;
  Vec3 aim_ = Vec3::Zero();   // on the surface
  Vec3 begin_ = Vec3::Zero(); // the aim when the tip was pressed on
  double t_ = 0;              // [s], of the pointer
  double newtons_ = 0;        // with which it is pressed there; 0: it is not
  double softness_ = 0;       // of what it is pressed on [m/N]
  QElapsedTimer pressed_;     // since that was followed last
  bool down_ = false, lingers_ = false;
  bool presses_ = false; // and paints nothing
  QElapsedTimer released_;
  std::size_t lingered_ = 0; // ticks since then
  ToolSample last_;
  std::size_t mirrored_ = 0; // the object that was pointed at last
  int refreshes_ = 0;
};

} // namespace patina
