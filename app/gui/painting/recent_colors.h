// The colours that were chosen last beside the swatches, kept between sessions.
#pragma once

#include <vector>

#include <QColor>

namespace patina {

std::vector<QColor> recentColors(); // the newest first, eight at most
void rememberColor(const QColor& color);

} // namespace patina
