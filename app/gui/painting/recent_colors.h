// The last colours that are no swatches, stored between sessions.
#pragma once

#include <vector>

#include <QColor>

namespace patina {

std::vector<QColor> recentColors(); // The newest first, at most eight.
void rememberColor(const QColor& color);

} // namespace patina
