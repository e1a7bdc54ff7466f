// Points, lines and labels of measurements and pins, over everything else.
#pragma once

#include <string>
#include <vector>

#include <vtkActor.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include "core/types.h"
#include "scene/pin.h"
#include "visualization/values/text_style.h"

namespace patina {

struct Annotation {
  std::vector<Vec3> points; // drawn as dots [m]
  std::vector<Vec3> line;   // drawn as one line; empty: none
  std::string label;        // text beside the last point; empty: none
  palette::Color color = palette::kForce;
  bool operator==(const Annotation&) const = default;
};

// Dots with the pins' names.
std::vector<Annotation> pinAnnotations(const std::vector<Pin>& pins);

class AnnotationLayer {
 public:
  explicit AnnotationLayer(vtkRenderer& overlay); // outlives it
  ~AnnotationLayer();
  AnnotationLayer(const AnnotationLayer&) = delete;
  AnnotationLayer& operator=(const AnnotationLayer&) = delete;

  void set(const std::vector<Annotation>& annotations);
  void setTextStyle(const TextStyle& letters);

 private:
  struct Drawn {
    vtkSmartPointer<vtkActor> dots, line;
    vtkSmartPointer<vtkTextActor> label;
    palette::Color color;
  };
  void clear();

  vtkRenderer& overlay_;
  std::vector<Drawn> drawn_;
};

} // namespace patina
