// An edit of the history as a person says it, with units that suit its size.
#pragma once

#include <string>

#include <QString>

namespace patina {

// "tip.radius" as "tip radius", "friction.static" as "static friction".
QString wordsOfKeys(QString words);

// "offset = 0.00124" is "Offset 1.24 mm", "color" is "Painted colour".
QString wordsOfEdit(const std::string& edit);

} // namespace patina
