#include "visualization/view/overlay_drawing.h"

#include <algorithm>
#include <array>
#include <sstream>

#include <vtkAxesActor.h>
#include <vtkCaptionActor2D.h>
#include <vtkCellArray.h>
#include <vtkCoordinate.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkPropCollection.h>
#include <vtkProperty2D.h>
#include <vtkRendererCollection.h>
#include <vtkScalarBarActorInternal.h>
#include <vtkTextRenderer.h>

namespace patina {
namespace {

// VTK justifies by the extent of the highest and lowest letters. Fractions of the font's size.
constexpr double kBelowBase = 0.21, kAboveBase = 0.74, kLineSpacing = 1.15;

// VTK shows the actors of a bar's numbers to subclasses only.
struct BarAccess : vtkScalarBarActor {
  static auto internals() { return &BarAccess::P; }
  static auto title() { return &BarAccess::TitleActor; }
};

Vec2 placeIn(vtkCoordinate& coordinate, vtkRenderer& renderer) {
  const double* place = coordinate.GetComputedDoubleDisplayValue(&renderer);
  return {place[0], place[1]};
}

palette::Color colorOf(double* rgb) {
  return {rgb[0], rgb[1], rgb[2]};
}

} // namespace

TakenOverlay::TakenOverlay(vtkRenderWindow& window) {
  for (int i = 0; i < window.GetRenderers()->GetNumberOfItems(); ++i) {
    auto* renderer = vtkRenderer::SafeDownCast(window.GetRenderers()->GetItemAsObject(i));
    if (renderer->GetDraw() != 0) take(*renderer);
  }
  for (vtkProp* prop : hidden_) prop->VisibilityOff();
  for (vtkTextProperty* text : transparent_) text->SetOpacity(0);
}

TakenOverlay::~TakenOverlay() {
  for (vtkProp* prop : hidden_) prop->VisibilityOn();
  for (vtkTextProperty* text : transparent_) text->SetOpacity(1);
}

void TakenOverlay::take(vtkRenderer& renderer) {
  vtkPropCollection* props = renderer.GetViewProps();
  for (int i = 0; i < props->GetNumberOfItems(); ++i) {
    auto* prop = vtkProp::SafeDownCast(props->GetItemAsObject(i));
    if (prop->GetVisibility() == 0) continue;
    if (auto* axes = vtkAxesActor::SafeDownCast(prop)) {
      for (vtkCaptionActor2D* caption :
           {axes->GetXAxisCaptionActor2D(), axes->GetYAxisCaptionActor2D(),
            axes->GetZAxisCaptionActor2D()}) {
        takeText(*caption->GetTextActor(), renderer);
        transparent_.push_back(caption->GetCaptionTextProperty());
      }
    } else if (auto* bar = vtkScalarBarActor::SafeDownCast(prop)) {
      takeBar(*bar, renderer);
    } else if (auto* text = vtkTextActor::SafeDownCast(prop)) {
      takeText(*text, renderer);
      hidden_.push_back(text);
    } else if (auto* actor = vtkActor2D::SafeDownCast(prop)) {
      takeLines(*actor, renderer);
    }
  }
}

void TakenOverlay::takeText(vtkTextActor& actor, vtkRenderer& renderer) {
  if (actor.GetInput() == nullptr) return;
  vtkTextProperty& style = *actor.GetTextProperty();
  const int dpi = renderer.GetRenderWindow()->GetDPI();
  DrawnText drawn;
  drawn.size = style.GetFontSize() * dpi / 72.0;
  drawn.bold = style.GetBold() != 0;
  drawn.color = colorOf(style.GetColor());
  std::vector<std::string> lines;
  std::istringstream text(actor.GetInput());
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  const Vec2 place = placeIn(*actor.GetActualPositionCoordinate(), renderer);
  const double step = kLineSpacing * drawn.size;
  const double below = static_cast<double>(lines.size() - 1) * step; // the last base line
  double base = place.y() + kBelowBase * drawn.size + below;
  if (style.GetVerticalJustification() == VTK_TEXT_TOP) base = place.y() - kAboveBase * drawn.size;
  if (style.GetVerticalJustification() == VTK_TEXT_CENTERED)
    base = place.y() - 0.5 * (kAboveBase - kBelowBase) * drawn.size + 0.5 * below;
  for (const std::string& line : lines) {
    const auto first = line.find_first_not_of(' ');
    const double at = base;
    base -= step;
    if (first == std::string::npos) continue;
    std::array<int, 4> box{}, blank{};
    vtkTextRenderer& letters = *vtkTextRenderer::GetInstance();
    letters.GetBoundingBox(&style, line, box.data(), dpi);
    letters.GetBoundingBox(&style, "n", blank.data(), dpi);
    // Spaces at the ends make plates wider than their texts.
    const double space = 0.278 * drawn.size; // Helvetica's
    const auto last = line.find_last_not_of(' ');
    drawn.text = line.substr(first, last + 1 - first);
    drawn.width =
        box[1] - box[0] + 1 - space * static_cast<double>(line.size() - drawn.text.size());
    double left = place.x();
    if (style.GetJustification() == VTK_TEXT_CENTERED) left -= 0.5 * (box[1] - box[0]);
    if (style.GetJustification() == VTK_TEXT_RIGHT) left -= box[1] - box[0];
    drawn.start = Vec2(left + space * static_cast<double>(first), at);
    drawing_.texts.push_back(drawn);
  }
}

void TakenOverlay::takeLines(vtkActor2D& actor, vtkRenderer& renderer) {
  auto* mapper = vtkPolyDataMapper2D::SafeDownCast(actor.GetMapper());
  if (mapper == nullptr || mapper->GetInput() == nullptr) return;
  vtkPolyData& data = *mapper->GetInput();
  if (data.GetNumberOfLines() == 0 || data.GetNumberOfPolys() > 0) return;
  const double* port = renderer.GetViewport();
  const int* size = renderer.GetRenderWindow()->GetSize();
  const Vec2 corner = Vec2(port[0] * size[0], port[1] * size[1]) +
                      placeIn(*actor.GetActualPositionCoordinate(), renderer);
  vtkCellArray& lines = *data.GetLines();
  for (vtkIdType cell = 0; cell < lines.GetNumberOfCells(); ++cell) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    lines.GetCellAtId(cell, count, ids);
    DrawnLine drawn;
    drawn.width = actor.GetProperty()->GetLineWidth();
    drawn.color = colorOf(actor.GetProperty()->GetColor());
    for (vtkIdType i = 0; i < count; ++i) {
      const double* point = data.GetPoint(ids[i]);
      drawn.points.emplace_back(corner + Vec2(point[0], point[1]));
    }
    drawing_.lines.push_back(std::move(drawn));
  }
  hidden_.push_back(&actor);
}

void TakenOverlay::takeBar(vtkScalarBarActor& bar, vtkRenderer& renderer) {
  takeText(*(bar.*BarAccess::title()), renderer);
  for (const auto& number : (bar.*BarAccess::internals())->TextActors) takeText(*number, renderer);
  transparent_.push_back(bar.GetTitleTextProperty());
  transparent_.push_back(bar.GetLabelTextProperty());
}

} // namespace patina
