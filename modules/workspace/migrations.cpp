#include "workspace/migrations.h"

namespace patina {

void migrateValues(std::vector<std::pair<std::string, std::string>>& values) {
  std::erase_if(values, [](const auto& value) { return value.first == "history"; });
  for (auto& [key, text] : values)
    if (key == "contact" && text == "potential") text = "proxy";
}

} // namespace patina
