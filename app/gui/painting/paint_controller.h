// Painting in the window: the current tool, its brush, and the pointer that paints with it.
#pragma once

#include <memory>
#include <vector>

#include <QElapsedTimer>
#include <QObject>

#include "app/gui/painting/brush_panel.h"
#include "app/gui/painting/brush_presets.h"
#include "app/gui/panels/tool_bar.h"
#include "app/gui/panels/tool_panel.h"
#include "app/gui/toolkit/scene_widget.h"
#include "haptics/servo/tip_servo.h"
#include "session/edit/edit_thread.h"

namespace patina {

// The pointer presses the tool onto the surface under it. The servo computes the contact, and the
// brush paints while there is contact. All parts outlive this object.
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

  void setScene(std::shared_ptr<const CompiledScene> scene, bool is_new); // nullptr: none.
  void feed(const std::vector<ToolSample>& ticks); // Called on each tick of the window.
  void refresh();                                  // Updates the brush cursor.
  void resizeBrush(double factor);
  void softenBrush(double factor);
  void setForce(double newtons); // Force of the mouse [N].

 signals:
  void chosen(const patina::ToolChoice& choice);

 private:
  void take(const ToolChoice& choice);
  Brush brush() const { return presets_.brush(tool_); }
  void setBrush(const Brush& brush);
  void pickAt(const Vec3& surface);
  void follow(const Pointed& where);
  void press(const Vec3& surface, double newtons);
  Vec3 lifted() const;               // The point above the aim.
  void lift();                       // Moves the tip there at once.
  void escape();                     // Cancels the stroke.
  void leapTip(const Vec3& target) { // Jumps, so that the tip does not pass through the object.
    at_.view.setTarget(target);
    at_.feel.jumpTarget(target, t_);
  }
  void passTip(const Vec3& target); // Moves when the servo reaches this event's time.
  std::optional<SurfaceValues> valuesAt(const Vec3& surface) const;
  bool arrived(const std::vector<ToolSample>& ticks) const;
  void sendHand(bool paints); // Tells the edit thread how the pointer holds the brush.
  void stopPainting() {
    if (std::exchange(paints_, false)) at_.edits.finishPainting();
  }
  void showMirror(bool paints);
  void showCursor(const std::optional<Vec3>& surface);

  Parts at_;
  std::shared_ptr<const CompiledScene> scene_;
  BrushPresets presets_;
  Tool tool_ = Tool::color;   // The brush's tool, even while another one is in use.
  bool paints_ = false;       // The edit thread follows the hand.
  bool touched_ = false;      // A tick was in contact since pressing began.
  Vec3 aim_ = Vec3::Zero();   // Point on the surface.
  Vec3 begin_ = Vec3::Zero(); // The aim when pressing began.
  double t_ = 0;              // Time of the pointer [s].
  double force_ = 0;          // Pressing force [N]; 0: not pressed.
  double compliance_ = 0;     // Compliance at the aim [m/N].
  QElapsedTimer pressed_;     // Time since the last press.
  bool down_ = false, in_grace_ = false;
  bool presses_ = true; // Presses without painting.
  QElapsedTimer released_;
  std::size_t grace_ticks_ = 0; // Ticks since the release.
  ToolSample last_;
  std::size_t mirrored_ = 0; // The object that was pointed at last.
};

} // namespace patina
