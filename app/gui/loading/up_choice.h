// The up axis of mesh files, stored between sessions.
#pragma once

#include <QSettings>

#include "geometry/mesh/mesh_unit.h"

namespace patina {

inline UpAxis rememberedUp() {
  return QSettings().value(QStringLiteral("y_up")).toBool() ? UpAxis::y : UpAxis::z;
}

inline void rememberUp(UpAxis up) {
  QSettings().setValue(QStringLiteral("y_up"), up == UpAxis::y);
}

} // namespace patina
