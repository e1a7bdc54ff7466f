// Words for people where no class of Qt's is at hand to ask for them.
#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include <QCoreApplication>
#include <QRegularExpression>

#include "core/numbers.h"

namespace patina {

inline QString tr(std::string_view words) {
  return QCoreApplication::translate("Window", std::string(words).c_str());
}

// What would be written "-0.0" is 0.
inline double shownAs(double value, int decimals) {
  return std::abs(value) < 0.5 * std::pow(10, -decimals) ? 0 : value;
}

// A number and its unit stay on one line.
inline constexpr QChar kNoBreak{0x00A0};

// "50 um" as people write it.
inline QString withMicro(QString words) {
  static const QRegularExpression kMicro(QStringLiteral("(?<=\\d) um\\b"));
  return words.replace(kMicro, QStringLiteral(" µm"));
}

// Of a text of the library's that names no file.
inline QString inWords(const std::string& text) {
  static const QRegularExpression kUnit(
      QStringLiteral("(?<=\\d) (?=(µm|mm|cm|m|N|N/m|dB|%)(?![\\wµ]))"));
  return withMicro(QString::fromStdString(text)).replace(kUnit, QString(kNoBreak));
}

inline QString inWords(double metres) {
  return inWords(std::abs(metres) < 0.5e-9 ? "0 mm" : formatLength(metres)); // rounding
}

} // namespace patina
