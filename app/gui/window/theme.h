// The window's colours: light or dark, as the desktop is. A theme may be applied at any time: what
// is dressed, drawn icons and 3D views follow, and so does all that asks for ink as it paints.
#pragma once

#include <QApplication>
#include <QColor>
#include <QString>

#include "visualization/values/palette.h"

namespace patina {

enum class Theme { light, dark };

// Of the palette that Qt has of the desktop, whatever style is applied.
Theme systemTheme();
void applyStyle(QApplication& application, Theme theme);

// Of the theme that was applied: "text", "quiet", "line" ..., see the table. The name must be one.
QColor ink(const char* name);
// What a 3D view stands on.
const palette::Ground& pictureGround();
// Gives it a style sheet whose colours are such names behind an @.
void dress(QWidget& widget, const QString& sheet);
// A small caption and a box below it; what every card of the side panel is.
void dressAsCards(QWidget& widget);

} // namespace patina
