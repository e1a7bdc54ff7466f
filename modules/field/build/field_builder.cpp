#include "field/build/field_builder.h"

#include <malloc.h>
#include <utility>

namespace patina {

SurfaceField frozen(FieldBuilder&& builder) {
  SurfaceField field = std::move(builder.field);
  field.distance = std::move(builder.distance);
  field.face = std::move(builder.face);
  ::malloc_trim(0); // what the stages took goes back to the system
  return field;
}

} // namespace patina
