// Draws the path of a scan as a tube coloured by a value, thin across bridged gaps, with marks at
// rejected measurements.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <vtkActor.h>
#include <vtkGlyph3DMapper.h>
#include <vtkLookupTable.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>

#include "core/types.h"
#include "scene/color_scale.h"

namespace patina {

struct DrawnSample {
  double t = 0;                 // [s]
  Vec3 position = Vec3::Zero(); // [m]
  double value = 0;             // in the unit of the title; not finite: no value
  bool bridged = false;         // interpolated across a gap
  bool begins = false;          // no line from the previous sample
  std::optional<Vec3> foot{};   // corresponding point on the surface [m]
};

struct DrawnPath {
  std::vector<DrawnSample> samples; // in order of time
  std::string title;                // title of the values: "force [N]"
  bool bar = true;                  // show the scalar bar
  double min_span = 0;              // min range of the colours
  ColorScale scale{};               // its range is in the unit of the values
  double stretch = 0; // scale of the residual lines from each foot towards its sample; 0: none
  bool show_through = false; // draw a dark line that shows through surfaces
};

struct DrawnMark {
  double t = 0;
  Vec3 position = Vec3::Zero();
};

class PathLayer {
 public:
  // scene: hidden by surfaces in front; overlay: renderer of the scalar bar.
  PathLayer(vtkRenderer& scene, vtkRenderer& overlay);

  // Merges samples that are too close to distinguish.
  void setPath(const DrawnPath& path);
  void setMarks(const std::vector<DrawnMark>& marks);
  vtkScalarBarActor& bar() { return *bar_; }
  vtkLookupTable* colors() const { return colors_; } // nullptr: no values
  bool hasBar() const { return has_bar_; }
  Box3 extent() const;                                // path and marks; empty if there are none
  const std::string& title() const { return title_; } // title of the values
  // The sample, or a mark without a value, that is drawn nearest to a point of the picture; x and y
  // in pixels from the lower left. nullopt: nothing is drawn within `reach`.
  std::optional<DrawnSample> sampleAt(vtkRenderer& scene, double x, double y, double reach) const;

 private:
  std::vector<DrawnSample> drawn_;
  std::string title_;
  std::vector<DrawnMark> marks_;
  vtkSmartPointer<vtkActor> tube_, line_, overlay_line_, bridge_, residuals_,
      mark_actor_; // line_ is visible from afar, too
  vtkSmartPointer<vtkGlyph3DMapper> mark_mapper_;
  vtkSmartPointer<vtkLookupTable> colors_;
  vtkSmartPointer<vtkScalarBarActor> bar_;
  bool has_bar_ = false;
};

} // namespace patina
