#include "field/build/field_builder.h"

#include <utility>

#include <tbb/parallel_for.h>

namespace patina {

SurfaceField frozen(FieldBuilder&& builder) {
  SurfaceField field = std::move(builder.field);
  field.distance.resize(builder.distance.size());
  field.face.resize(builder.face.size());
  tbb::parallel_for(std::size_t{0}, builder.face.size(), [&](std::size_t slot) {
    field.distance[slot] = std::make_shared<const DistanceBlock>(*builder.distance[slot]);
    builder.distance[slot].reset();
    field.face[slot] = std::make_shared<const FaceBlock>(*builder.face[slot]);
    builder.face[slot].reset();
  });
  return field;
}

} // namespace patina
