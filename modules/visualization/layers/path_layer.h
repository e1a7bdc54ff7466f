// The path of a scan: a tube coloured by a value, thin where it only bridges a gap, with what was
// left out of it beside it.
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

namespace patina {

struct DrawnSample {
  double t = 0;                 // [s]
  Vec3 position = Vec3::Zero(); // [m]
  double value = 0;             // in the unit of the title; not finite: none
  bool bridged = false;         // nobody saw it: a gap's
  bool begins = false;          // nothing leads here from the sample before
  std::optional<Vec3> foot{};   // where on a surface it should lie [m]
};

struct DrawnPath {
  std::vector<DrawnSample> samples; // in the order of time
  std::string title;                // of the values: "force [N]"
  bool bar = true;                  // says what the colours are
  double least_span = 0;            // of the values that the colours tell apart
  double stretch = 0;   // lines from each foot towards its sample, so many times as long; 0: none
  bool through = false; // a dark thread along it is seen through what hides it
};

// What was seen and is not part of the path.
struct DrawnMark {
  double t = 0;
  Vec3 position = Vec3::Zero();
};

class PathLayer {
 public:
  // scene: hidden by surfaces in front of it; overlay: where the scalar bar is.
  PathLayer(vtkRenderer& scene, vtkRenderer& overlay);

  // Of very many samples those are drawn that can be told apart.
  void setPath(const DrawnPath& path);
  void setMarks(const std::vector<DrawnMark>& marks);
  vtkScalarBarActor& bar() { return *bar_; }
  vtkLookupTable* colors() const { return colors_; } // of the values; nullptr: it has none
  bool hasBar() const { return has_bar_; }
  Box3 extent() const; // of path and marks; empty without any
  // When the tip was nearest to a point of the picture, x and y in pixels from its lower left;
  // nullopt: nothing drawn is within `reach`.
  std::optional<double> timeAt(vtkRenderer& scene, double x, double y, double reach) const;

 private:
  std::vector<DrawnSample> drawn_;
  std::vector<DrawnMark> marks_;
  vtkSmartPointer<vtkActor> tube_, line_, thread_, bridge_, residuals_,
      mark_actor_; // a line is seen from afar, too
  vtkSmartPointer<vtkGlyph3DMapper> mark_mapper_;
  vtkSmartPointer<vtkLookupTable> colors_;
  vtkSmartPointer<vtkScalarBarActor> bar_;
  bool has_bar_ = false;
};

} // namespace patina
