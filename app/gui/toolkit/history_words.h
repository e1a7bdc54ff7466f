// Describes an edit of the history, with suitable units.
#pragma once

#include <string>

#include <QString>

namespace patina {

// Converts "tip.radius" to "tip radius", "friction.static" to "static friction".
QString wordsOfKeys(QString words);

// Converts "offset = 0.00124" to "Offset 1.24 mm", "color" to "Painted colour".
QString wordsOfEdit(const std::string& edit);

} // namespace patina
