#include "architecture/floors.h"

#include <sstream>
#include <stdexcept>

namespace patina::architecture {
namespace {

// "modules/haptics/law/stage.h" is in folder "law" of room "modules/haptics".
struct Address {
  std::string room, folder;
};

Address addressOf(const std::string& path) {
  const std::size_t first = path.find('/');
  const std::size_t second = path.find('/', first + 1);
  if (second == std::string::npos) return {};
  const std::size_t third = path.find('/', second + 1);
  if (third == std::string::npos) return {path.substr(0, second), "."};
  return {path.substr(0, second), path.substr(second + 1, third - second - 1)};
}

std::string includedPath(const std::string& line) {
  const std::string opening = "#include \"";
  if (!line.starts_with(opening)) return {};
  const std::string included = line.substr(opening.size(), line.rfind('"') - opening.size());
  return included.starts_with("app/") ? included : "modules/" + included;
}

} // namespace

Floors floorsIn(const std::string& table) {
  Floors floors;
  std::istringstream text(table);
  for (std::string line; std::getline(text, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) throw std::runtime_error("no room in: " + line);
    std::map<std::string, int>& room = floors[line.substr(0, colon)];
    std::istringstream words(line.substr(colon + 1));
    int floor = 0;
    for (std::string word; words >> word;) {
      if (word == "<")
        ++floor;
      else if (!room.emplace(word, floor).second)
        throw std::runtime_error(word + " stands twice in: " + line);
    }
  }
  return floors;
}

std::vector<std::string> floorViolations(const Floors& floors, const SourceFile& file) {
  std::vector<std::string> violations;
  const Address from = addressOf(file.path);
  const auto room = floors.find(from.room);
  const auto floorOf = [&](const std::string& folder) {
    const auto found = room->second.find(folder);
    return found == room->second.end() ? -1 : found->second;
  };
  std::istringstream text(file.text);
  for (std::string line; std::getline(text, line);) {
    const std::string included = includedPath(line);
    const Address to = addressOf(included);
    if (included.empty() || to.room != from.room || to.folder == from.folder) continue;
    std::string cause;
    if (room == floors.end())
      cause = from.room + " has no floors";
    else if (floorOf(from.folder) < 0 || floorOf(to.folder) < 0)
      cause = "modules/floors.txt does not name the folder";
    else if (floorOf(to.folder) >= floorOf(from.folder))
      cause = to.folder + " is not below " + from.folder;
    if (!cause.empty()) violations.push_back(file.path + ": " + included + ": " + cause);
  }
  return violations;
}

} // namespace patina::architecture
