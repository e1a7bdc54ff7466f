// Words for people where no class of Qt's is at hand to ask for them.
#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include <QCoreApplication>

#include "core/numbers.h"

namespace patina {

inline QString tr(std::string_view words) {
  return QCoreApplication::translate("Window", std::string(words).c_str());
}

inline QString inWords(double metres) {
  if (metres == 0 || std::abs(metres) < 0.5e-9) return QStringLiteral("0 mm"); // rounding
  return QString::fromStdString(formatLength(metres)).replace(" um", " µm");
}

} // namespace patina
