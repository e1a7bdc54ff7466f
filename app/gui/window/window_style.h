// The window's look: one light palette, whatever the desktop's theme.
#pragma once

#include <QApplication>
#include <QColor>
#include <QString>

#include "visualization/values/palette.h"

namespace patina {

void applyStyle(QApplication& application);
QColor toQColor(const palette::Color& color);
// A small caption and a box below it; what every card of the side panel is.
QString cardStyle();

} // namespace patina
