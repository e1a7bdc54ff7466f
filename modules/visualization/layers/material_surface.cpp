#include "visualization/layers/material_surface.h"

#include <algorithm>

#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "visualization/surfaces/refined_surface.h"
#include "visualization/surfaces/surface_data.h"
#include "visualization/values/palette.h"
#include "visualization/view/scene_furniture.h"

namespace patina {
namespace {

vtkPolyDataMapper& mapperOf(vtkActor& actor) {
  return *vtkPolyDataMapper::SafeDownCast(actor.GetMapper());
}

// A brush reaches over several voxels, and linear pieces of this size follow what it leaves; finer
// ones would be seen in the time of a frame where OpenGL is software.
constexpr double kEdgeVoxels = 2;
constexpr std::size_t kMostShown = 150'000;

// A node's value reaches one voxel to either side of it.
Box3 reachOf(const MaterialMap& map, const MaterialMap::Index& block) {
  const Vec3 first(kMaterialSide * block[0], kMaterialSide * block[1], kMaterialSide * block[2]);
  return Box3(map.origin() + map.voxel() * (first - Vec3::Ones()),
              map.origin() + map.voxel() * (first + Vec3::Constant(kMaterialSide)));
}

} // namespace

std::optional<std::vector<Box3>> changedPlaces(const MaterialMap* before, const MaterialMap& now,
                                               MaterialChannel channel) {
  if (before == nullptr || before->origin() != now.origin() || before->voxel() != now.voxel())
    return std::nullopt;
  std::vector<Box3> places;
  const auto c = static_cast<std::size_t>(channel);
  const auto check = [&](const MaterialMap& these, const MaterialMap& others, bool both) {
    for (const auto& [index, block] : these.blocks()) {
      const MaterialLayer* other = others.layer(index, channel);
      if (block.layer[c].get() == other || (other != nullptr && !both)) continue;
      places.push_back(reachOf(now, index));
    }
  };
  check(now, *before, true);
  check(*before, now, false); // what is there no more
  return places;
}

MaterialSurface::MaterialSurface() : actor_(surfaceActor(palette::kSurface)) {
  vtkPolyDataMapper& mapper = mapperOf(*actor_);
  mapper.ScalarVisibilityOn();
  mapper.UseLookupTableScalarRangeOn();
  mapper.InterpolateScalarsBeforeMappingOn();
  // Shine would shift colours that are to be read.
  actor_->GetProperty()->SetSpecular(0);
  actor_->GetProperty()->SetAmbient(0.3);
}

void MaterialSurface::set(const SceneObject& object, const Material& base) {
  if (object.mesh != mesh_) {
    mesh_ = object.mesh;
    fineness_ = 0;
  }
  map_ = object.paint->material;
  base_ = base;
  place(*actor_, object.world_from_object);
}

ValueRange MaterialSurface::prepare(MaterialChannel channel) {
  const double base = valueOf(base_, channel);
  if (fineness_ != map_->voxel()) {
    fineness_ = map_->voxel();
    const RefinedSurface fine = refined(*mesh_, kEdgeVoxels * fineness_, kMostShown);
    std::vector<std::int32_t> vertex;
    const auto data = surfaceData(fine.mesh, fine.normals, vertex);
    points_.clear();
    for (const std::int32_t v : vertex)
      points_.push_back(fine.mesh.positions[static_cast<std::size_t>(v)]);
    const vtkNew<vtkFloatArray> values;
    values->SetNumberOfValues(static_cast<vtkIdType>(points_.size()));
    data->GetPointData()->SetScalars(values);
    mapperOf(*actor_).SetInputData(data);
    shown_ = nullptr;
  }
  const bool same_kind = shown_ != nullptr && channel_ == channel && shown_base_ == base;
  if (same_kind && shown_ == map_) return range_;
  const auto places = same_kind ? changedPlaces(shown_.get(), *map_, channel) : std::nullopt;
  if (!same_kind) range_ = {base, base};
  evaluate(channel, places ? &*places : nullptr);
  shown_ = map_;
  channel_ = channel;
  shown_base_ = base;
  return range_;
}

void MaterialSurface::evaluate(MaterialChannel channel, const std::vector<Box3>* places) {
  Box3 all;
  if (places != nullptr)
    for (const Box3& place : *places) all.extend(place);
  auto* values =
      vtkFloatArray::SafeDownCast(mapperOf(*actor_).GetInput()->GetPointData()->GetScalars());
  for (std::size_t p = 0; p < points_.size(); ++p) {
    if (places != nullptr && (!all.contains(points_[p]) ||
                              std::none_of(places->begin(), places->end(), [&](const Box3& place) {
                                return place.contains(points_[p]);
                              })))
      continue;
    const double value = valueOf(map_->at(points_[p], base_), channel);
    range_ = {std::min(range_.low, value), std::max(range_.high, value)};
    values->SetValue(static_cast<vtkIdType>(p), static_cast<float>(value));
  }
  values->Modified();
  mapperOf(*actor_).GetInput()->Modified();
}

void MaterialSurface::setColors(vtkLookupTable* colors) {
  mapperOf(*actor_).SetLookupTable(colors);
}

} // namespace patina
