#include "visualization/values/scene_setup.h"

#include <array>

#include <vtkCaptionActor2D.h>
#include <vtkLight.h>
#include <vtkMatrix4x4.h>
#include <vtkProperty.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

namespace patina {
namespace {

std::array<vtkCaptionActor2D*, 3> captionsOf(vtkAxesActor& axes) {
  return {axes.GetXAxisCaptionActor2D(), axes.GetYAxisCaptionActor2D(),
          axes.GetZAxisCaptionActor2D()};
}
} // namespace

vtkSmartPointer<vtkActor> surfaceActor(const palette::Color& color) {
  auto actor = vtkSmartPointer<vtkActor>::New();
  const vtkNew<vtkPolyDataMapper> mapper;
  mapper->ScalarVisibilityOff();
  actor->SetMapper(mapper);
  vtkProperty* property = actor->GetProperty();
  property->SetColor(palette::forVtk(color));
  property->SetAmbient(0.16);
  property->SetDiffuse(0.88);
  property->SetSpecular(0.16);
  property->SetSpecularPower(24);
  property->SetEdgeColor(palette::forVtk(palette::kEdges));
  property->SetLineWidth(1);
  return actor;
}

vtkPolyDataMapper& mapperOf(vtkActor& actor) {
  return *vtkPolyDataMapper::SafeDownCast(actor.GetMapper());
}

vtkSmartPointer<vtkActor> surfaceActor(vtkPolyDataAlgorithm& source, const palette::Color& color) {
  source.Update();
  auto actor = surfaceActor(color);
  mapperOf(*actor).SetInputData(source.GetOutput());
  return actor;
}

void place(vtkActor& actor, const Pose& world_from_object) {
  const vtkNew<vtkMatrix4x4> matrix;
  const Eigen::Matrix4d pose = world_from_object.matrix();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix->SetElement(row, column, pose(row, column));
  actor.SetUserMatrix(matrix);
}

vtkSmartPointer<vtkActor> outlineActor(vtkOutlineSource& source) {
  const vtkNew<vtkPolyDataMapper> mapper;
  source.SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  mapper->SetInputConnection(source.GetOutputPort());
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(palette::forVtk(palette::kSecondary));
  actor->GetProperty()->SetLineWidth(1.5);
  actor->GetProperty()->LightingOff();
  return actor;
}

void addLights(vtkRenderer& renderer) {
  struct Lamp {
    Vec3 from; // camera frame: right, up, towards the viewer
    double intensity;
    palette::Color color;
  };
  // A warm key light from the upper left, a cool fill light from the lower right, a rim light
  // behind.
  const Lamp lamps[] = {{Vec3(-0.5, 0.7, 1.0), 0.82, {1.0, 0.98, 0.94}},
                        {Vec3(0.8, -0.5, 0.8), 0.34, {0.90, 0.95, 1.0}},
                        {Vec3(0.2, 0.6, -1.0), 0.25, {1.0, 1.0, 1.0}}};
  renderer.AutomaticLightCreationOff();
  for (const Lamp& lamp : lamps) {
    const vtkNew<vtkLight> light;
    light->SetLightTypeToCameraLight();
    light->SetPosition(lamp.from[0], lamp.from[1], lamp.from[2]);
    light->SetFocalPoint(0, 0, 0);
    light->SetIntensity(lamp.intensity);
    light->SetColor(palette::forVtk(lamp.color));
    renderer.AddLight(light);
  }
}

vtkSmartPointer<vtkAxesActor> axesActor() {
  auto axes = vtkSmartPointer<vtkAxesActor>::New();
  axes->SetShaftTypeToCylinder();
  axes->SetCylinderRadius(0.045);
  axes->SetConeRadius(0.32);
  axes->SetNormalizedShaftLength(0.75, 0.75, 0.75);
  axes->SetNormalizedTipLength(0.25, 0.25, 0.25);
  axes->SetNormalizedLabelPosition(1.25, 1.25, 1.25);
  vtkProperty* shafts[] = {axes->GetXAxisShaftProperty(), axes->GetYAxisShaftProperty(),
                           axes->GetZAxisShaftProperty()};
  vtkProperty* tips[] = {axes->GetXAxisTipProperty(), axes->GetYAxisTipProperty(),
                         axes->GetZAxisTipProperty()};
  const auto captions = captionsOf(*axes);
  const char* letters[] = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    shafts[i]->SetColor(palette::forVtk(kAxisColors[i]));
    tips[i]->SetColor(palette::forVtk(kAxisColors[i]));
    captions[i]->SetCaption(letters[i]);
    captions[i]->GetTextActor()->SetTextScaleModeToNone();
    vtkTextProperty* text = captions[i]->GetCaptionTextProperty();
    text->BoldOn();
    text->ItalicOff();
    text->ShadowOff();
  }
  return axes;
}

void setTextStyle(vtkAxesActor& axes, const TextStyle& letters) {
  const auto captions = captionsOf(axes);
  for (std::size_t i = 0; i < 3; ++i)
    write(*captions[i]->GetCaptionTextProperty(), letters, kAxisColors[i], false);
}

void setBackground(vtkRenderer& renderer, const palette::BackgroundStyle& ground) {
  renderer.SetBackground(palette::forVtk(ground.low));
  renderer.SetBackground2(palette::forVtk(ground.high));
  renderer.GradientBackgroundOn();
}

} // namespace patina
