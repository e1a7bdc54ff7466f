#include "field/store/field_builder.h"

#include <malloc.h>
#include <utility>

namespace patina {

SurfaceField finish(FieldBuilder&& builder) {
  SurfaceField field = std::move(builder.field);
  field.distance = std::move(builder.distance);
  field.face = std::move(builder.face);
  ::malloc_trim(0); // Returns the freed memory of the stages to the system.
  return field;
}

} // namespace patina
