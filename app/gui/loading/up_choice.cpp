#include "app/gui/loading/up_choice.h"

#include <QSettings>

namespace patina {
namespace {
const QString kYUp = QStringLiteral("y_up");
}

UpAxis rememberedUp() {
  return QSettings().value(kYUp).toBool() ? UpAxis::y : UpAxis::z;
}

void rememberUp(UpAxis up) {
  QSettings().setValue(kYUp, up == UpAxis::y);
}

} // namespace patina
