#include "visualization/layers/view_cube.h"

#include <array>
#include <cmath>

#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkProperty.h>

#include "visualization/values/scene_setup.h"

namespace patina {
namespace {

constexpr double kHalf = 0.5;
constexpr double kMiddle = 0.66; // half width of a side's middle part, in half sides
constexpr double kAbove = 1.006; // scale of the highlight, just above the cube

std::array<vtkProperty*, 6> facesOf(vtkAnnotatedCubeActor& cube) {
  return {cube.GetXPlusFaceProperty(),  cube.GetXMinusFaceProperty(), cube.GetYPlusFaceProperty(),
          cube.GetYMinusFaceProperty(), cube.GetZPlusFaceProperty(),  cube.GetZMinusFaceProperty()};
}

// Shades the cube slightly, so that its letters are legible on every side.
void light(vtkProperty& property, double diffuse) {
  property.SetAmbient(1 - diffuse);
  property.SetDiffuse(diffuse);
  property.SetSpecular(0);
}

// Range of a patch along one axis, in half sides.
std::array<double, 2> partOf(double component) {
  if (component == 0) return {-kMiddle, kMiddle};
  return component > 0 ? std::array{kMiddle, 1.} : std::array{-1., -kMiddle};
}

} // namespace

std::optional<Vec3> cubeSideAt(const Ray& ray) {
  double from = -1e9, to = 1e9;
  int face = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = ray.direction[axis];
    if (std::abs(way) < 1e-12) {
      if (std::abs(ray.origin[axis]) > kHalf) return std::nullopt;
      continue;
    }
    const double a = (-kHalf - ray.origin[axis]) / way, b = (kHalf - ray.origin[axis]) / way;
    if (std::min(a, b) > from) from = std::min(a, b), face = axis;
    to = std::min(to, std::max(a, b));
  }
  if (from > to || to < 0) return std::nullopt;
  const Vec3 hit = (ray.origin + from * ray.direction) / kHalf;
  Vec3 side = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis)
    if (axis == face || std::abs(hit[axis]) > kMiddle) side[axis] = hit[axis] > 0 ? 1 : -1;
  return side;
}

ViewCube::ViewCube(vtkRenderer& corner)
    : corner_(corner), cube_(vtkSmartPointer<vtkAnnotatedCubeActor>::New()),
      patches_(vtkSmartPointer<vtkPolyData>::New()), highlight_(surfaceActor(palette::kTool)) {
  cube_->SetXPlusFaceText("+x");
  cube_->SetXMinusFaceText("-x");
  cube_->SetYPlusFaceText("+y");
  cube_->SetYMinusFaceText("-y");
  cube_->SetZPlusFaceText("+z");
  cube_->SetZMinusFaceText("-z");
  cube_->SetZFaceTextRotation(90); // upright in the view of turnFrom()
  cube_->SetFaceTextScale(0.5);
  cube_->SetTextEdgesVisibility(0);
  cube_->GetCubeProperty()->EdgeVisibilityOn();
  cube_->GetCubeProperty()->SetLineWidth(1.5);
  light(*cube_->GetCubeProperty(), 0.2);
  for (vtkProperty* face : facesOf(*cube_)) light(*face, 0);
  mapperOf(*highlight_).SetInputData(patches_);
  highlight_->GetProperty()->LightingOff();
  highlight_->GetProperty()->SetOpacity(0.6);
  corner_.AddActor(cube_);
  corner_.AddActor(highlight_);
  setHighlighted(std::nullopt);
}

ViewCube::~ViewCube() {
  corner_.RemoveActor(cube_);
  corner_.RemoveActor(highlight_);
}

void ViewCube::setBackgroundStyle(const palette::BackgroundStyle& ground) {
  cube_->GetCubeProperty()->SetColor(palette::forVtk(ground.low));
  cube_->GetCubeProperty()->SetEdgeColor(palette::forVtk(ground.shaft));
  const auto faces = facesOf(*cube_);
  for (std::size_t i = 0; i < faces.size(); ++i)
    faces[i]->SetColor(palette::forVtk(legible(kAxisColors[i / 2], ground)));
}

void ViewCube::setHighlighted(const std::optional<Vec3>& side) {
  const vtkNew<vtkPoints> points;
  const vtkNew<vtkCellArray> quads;
  for (int axis = 0; side && axis < 3; ++axis) {
    if ((*side)[axis] == 0) continue;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto across = partOf((*side)[u]), high = partOf((*side)[v]);
    quads->InsertNextCell(4);
    for (int k = 0; k < 4; ++k) {
      Vec3 at;
      at[axis] = kAbove * (*side)[axis];
      at[u] = across[k == 1 || k == 2 ? 1 : 0];
      at[v] = high[k >= 2 ? 1 : 0];
      quads->InsertCellPoint(points->InsertNextPoint((kHalf * at).eval().data()));
    }
  }
  patches_->SetPoints(points);
  patches_->SetPolys(quads);
  patches_->Modified();
  highlight_->SetVisibility(side.has_value());
}

} // namespace patina
