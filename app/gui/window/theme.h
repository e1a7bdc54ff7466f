// The window's colours: light or dark, as the desktop is.
#pragma once

#include <QApplication>
#include <QColor>
#include <QString>

namespace patina {

enum class Theme { light, dark };

Theme systemTheme(); // before a style is applied
void applyStyle(QApplication& application, Theme theme);

// Of the theme that was applied: "text", "quiet", "line" ..., see the table. The name must be one.
QColor ink(const char* name);
// A style sheet whose colours are such names behind an @.
QString themed(const char* sheet);
// A small caption and a box below it; what every card of the side panel is.
QString cardStyle();

} // namespace patina
