// Translated texts outside Qt classes.
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

inline QString shownText(std::string_view utf8) {
  return QString::fromUtf8(utf8.data(), static_cast<int>(utf8.size()));
}

// Returns a message of the library for people at a window: without the clauses, of several, and
// the parentheses that name a command or an option. File names before the first ": " stay.
inline QString withoutCommands(QString message) {
  const QString command = QStringLiteral("(?:\\bpatina [a-z]|'patina [a-z]|(?<![\\w-])--[a-z])");
  static const QRegularExpression kAside(QStringLiteral(" \\([^()]*") + command +
                                         QStringLiteral("[^()]*\\)"));
  static const QRegularExpression kEnd(QStringLiteral("[,:] [^,:;]*") + command +
                                       QStringLiteral("[^;]*$"));
  static const QRegularExpression kCommand(command);
  const auto head = message.indexOf(QStringLiteral(": "));
  QString place = head < 0 ? QString() : message.left(head + 2);
  QStringList kept;
  for (QString clause : message.mid(place.size()).remove(kAside).split(QStringLiteral("; "))) {
    clause.remove(kEnd);
    if (kept.isEmpty() || !clause.contains(kCommand)) kept << clause;
  }
  return place + kept.join(QStringLiteral("; "));
}

// Avoids "-0.0".
inline double shownAs(double value, int decimals) {
  return std::abs(value) < 0.5 * std::pow(10, -decimals) ? 0 : value;
}

// Keeps a number and its unit on one line.
inline constexpr QChar kNoBreak{0x00A0};

// Replaces "um" by "µm".
inline QString withMicro(QString words) {
  static const QRegularExpression kMicro(QStringLiteral("(?<=\\d) um\\b"));
  return words.replace(kMicro, QStringLiteral(" µm"));
}

// Formats a text of the library that contains no file name.
inline QString inWords(const std::string& text) {
  static const QRegularExpression kUnit(
      QStringLiteral("(?<=\\d) (?=(µm|mm|cm|m|N|N/m|dB|%)(?![\\wµ]))"));
  return withMicro(shownText(text)).replace(kUnit, QString(kNoBreak));
}

inline QString inWords(double metres) {
  return inWords(std::abs(metres) < 0.5e-9 ? "0 mm" : formatLength(metres));
}

} // namespace patina
