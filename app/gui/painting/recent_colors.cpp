#include "app/gui/painting/recent_colors.h"

#include <QSettings>
#include <QStringList>

namespace patina {
namespace {
constexpr int kColorsKept = 8;
const QString kColorsKey = QStringLiteral("recent_colors");
} // namespace

std::vector<QColor> recentColors() {
  std::vector<QColor> colors;
  for (const QString& name : QSettings().value(kColorsKey).toStringList())
    if (const QColor color(name); color.isValid()) colors.push_back(color);
  return colors;
}

void rememberColor(const QColor& color) {
  QStringList names = QSettings().value(kColorsKey).toStringList();
  names.removeAll(color.name());
  names.prepend(color.name());
  while (names.size() > kColorsKept) names.removeLast();
  QSettings().setValue(kColorsKey, names);
}

} // namespace patina
