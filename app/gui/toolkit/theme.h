// The window's colours: light or dark, like the desktop. A theme may be applied at any time. Style
// sheets, drawn icons and 3D views follow, and so does painting with themeColor().
#pragma once

#include <QApplication>
#include <QColor>
#include <QString>

#include "visualization/values/palette.h"

namespace patina {

enum class Theme { light, dark };

// Returns the theme of the desktop's palette, independent of the applied style.
Theme systemTheme();
void applyStyle(QApplication& application, Theme theme);

// Returns a colour of the theme by its name in the table. Throws std::invalid_argument.
QColor themeColor(const char* name);
// Background of a 3D view.
const palette::BackgroundStyle& pictureGround();
// Sets a style sheet in which such names follow an @.
void applyStyleSheet(QWidget& widget, const QString& sheet);
// Gives it a small caption and a box below, like every card of the side panel.
void applyCardStyle(QWidget& widget);

} // namespace patina
