// What is up in the mesh files that a person opens, kept from one session to the next.
#pragma once

#include "geometry/mesh/mesh_unit.h"

namespace patina {

UpAxis rememberedUp();
void rememberUp(UpAxis up);

} // namespace patina
