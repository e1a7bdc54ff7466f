// Texts and lines of a rendered window as plain values. Internal to the module.
#pragma once

#include <string>
#include <vector>

#include <vtkActor2D.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include "core/types.h"
#include "visualization/values/palette.h"

namespace patina {

// Coordinates in pixels from the lower left corner.
struct DrawnText {
  std::string text;          // UTF-8, one line
  Vec2 start = Vec2::Zero(); // left end of the base line
  double size = 13;          // font size
  double width = 0;          // VTK's own
  bool bold = false;
  palette::Color color{};
};
struct DrawnLine {
  std::vector<Vec2> points;
  double width = 1;
  palette::Color color{};
};
struct OverlayDrawing {
  std::vector<DrawnText> texts;
  std::vector<DrawnLine> lines;
};

// Takes what is visible in a window that was rendered, and hides it until it is destroyed.
class TakenOverlay {
 public:
  explicit TakenOverlay(vtkRenderWindow& window);
  ~TakenOverlay();
  TakenOverlay(const TakenOverlay&) = delete;
  TakenOverlay& operator=(const TakenOverlay&) = delete;
  const OverlayDrawing& drawing() const { return drawing_; }

 private:
  void take(vtkRenderer& renderer);
  void takeText(vtkTextActor& actor, vtkRenderer& renderer);
  void takeLines(vtkActor2D& actor, vtkRenderer& renderer);
  void takeBar(vtkScalarBarActor& bar, vtkRenderer& renderer);

  OverlayDrawing drawing_;
  std::vector<vtkProp*> hidden_;
  std::vector<vtkTextProperty*> transparent_;
};

} // namespace patina
