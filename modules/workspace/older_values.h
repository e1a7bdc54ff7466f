// Keys and values of a scene that older versions wrote and this one has no more.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace patina {

// What stands for them today: `contact = potential` becomes the usual contact, and `history` goes,
// which that contact needs no more. The rest, and the order, stay.
void renewValues(std::vector<std::pair<std::string, std::string>>& values);

} // namespace patina
