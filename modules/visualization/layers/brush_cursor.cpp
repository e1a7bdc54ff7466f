#include "visualization/layers/brush_cursor.h"

#include <algorithm>
#include <cmath>

#include <vtkCellArray.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "scene/surface_pick.h"
#include "visualization/surfaces/precise_points.h"
#include "visualization/values/palette.h"

namespace patina {
namespace {

constexpr int kSides = 72;

vtkSmartPointer<vtkActor> actorOf(vtkPolyData* data, const palette::Color& color, double width,
                                  double opacity, double offset) {
  const vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->ScalarVisibilityOff();
  mapper->SetResolveCoincidentTopologyToPolygonOffset();
  mapper->SetRelativeCoincidentTopologyLineOffsetParameters(0, offset);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  vtkProperty* property = actor->GetProperty();
  property->LightingOff();
  property->SetColor(palette::forVtk(color));
  property->SetLineWidth(static_cast<float>(width));
  property->SetOpacity(opacity);
  actor->PickableOff();
  actor->VisibilityOff();
  return actor;
}

// Projects a point down to the surface, from a radius above the tangent plane to a radius below it.
Vec3 laidDown(const Vec3& flat, const BrushCursorState& place, const SurfaceField* field) {
  if (field == nullptr) return flat;
  const Vec3 above = flat + place.radius * place.normal;
  const auto hit = firstSurfaceAlong(*field, above, -place.normal);
  return hit && (*hit - above).norm() <= 2 * place.radius ? *hit : flat;
}

} // namespace

BrushCursor::BrushCursor(vtkRenderer& overlay)
    : points_(precisePoints()), rings_(vtkSmartPointer<vtkPolyData>::New()),
      disc_(vtkSmartPointer<vtkPolyData>::New()),
      dark_(actorOf(rings_, palette::kContactPoint, 4, 1, 0)),
      light_(actorOf(rings_, {1, 1, 1}, 1.8, 1, -4)), fill_(actorOf(disc_, {1, 1, 1}, 1, 0.22, 0)) {
  points_->SetNumberOfPoints(2 * kSides + 1);
  const vtkNew<vtkCellArray> lines, triangles;
  for (int ring = 0; ring < 2; ++ring) {
    lines->InsertNextCell(kSides + 1);
    for (int side = 0; side <= kSides; ++side)
      lines->InsertCellPoint(ring * kSides + side % kSides);
  }
  for (int side = 0; side < kSides; ++side) {
    const vtkIdType outer = side, outer_next = (side + 1) % kSides;
    const vtkIdType inner = kSides + outer, inner_next = kSides + outer_next;
    for (const std::array<vtkIdType, 3>& corners :
         {std::array<vtkIdType, 3>{outer, outer_next, inner_next},
          std::array<vtkIdType, 3>{outer, inner_next, inner},
          std::array<vtkIdType, 3>{inner, inner_next, 2 * kSides}})
      triangles->InsertNextCell(3, corners.data());
  }
  rings_->SetPoints(points_);
  rings_->SetLines(lines);
  disc_->SetPoints(points_);
  disc_->SetPolys(triangles);
  for (const auto& actor : {fill_, dark_, light_}) overlay.AddActor(actor);
}

void BrushCursor::update(const std::optional<BrushCursorState>& place, const SurfaceField* field) {
  const bool shown = place && place->radius > 0 && place->centre.allFinite();
  for (const auto& actor : {fill_, dark_, light_}) actor->SetVisibility(shown);
  if (!shown) return;
  const Vec3 across = place->normal.unitOrthogonal();
  const Vec3 along = place->normal.cross(across);
  const double half =
      place->half_radius > 0 ? std::min(place->half_radius, place->radius) : place->radius;
  for (int ring = 0; ring < 2; ++ring)
    for (int side = 0; side < kSides; ++side) {
      const double angle = 2 * M_PI * side / kSides;
      const Vec3 direction = std::cos(angle) * across + std::sin(angle) * along;
      const Vec3 flat = place->centre + (ring == 0 ? place->radius : half) * direction;
      points_->SetPoint(ring * kSides + side, laidDown(flat, *place, field).data());
    }
  points_->SetPoint(2 * kSides, place->centre.data());
  points_->Modified();
  fill_->GetProperty()->SetColor(palette::forVtk(place->color));
}

} // namespace patina
