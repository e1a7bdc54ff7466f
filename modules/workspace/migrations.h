// Migrates keys and values of scenes from older versions.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace patina {

// Replaces `contact = potential` by the default contact and removes `history`, which it no longer
// needs. Other values and the order stay.
void migrateValues(std::vector<std::pair<std::string, std::string>>& values);

} // namespace patina
