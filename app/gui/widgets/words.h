// Words for people where no class of Qt's is at hand to ask for them.
#pragma once

#include <string>
#include <string_view>

#include <QCoreApplication>

#include "core/numbers.h"

namespace patina {

inline QString tr(std::string_view words) {
  return QCoreApplication::translate("Window", std::string(words).c_str());
}

inline QString inWords(double metres) {
  return QString::fromStdString(formatLength(metres));
}

} // namespace patina
