#include "architecture/plan_picture.h"

#include <algorithm>
#include <map>
#include <regex>
#include <sstream>
#include <vector>

#include "architecture/floors.h"

namespace patina::architecture {
namespace {

constexpr int kWidth = 1060, kLine = 15, kGap = 14, kTitle = 24;

using TextLines = std::vector<std::string>;

std::string textOfFile(const std::string& path) {
  return filesUnder({path}, [](const auto&) { return true; }).at(0).text;
}

TextLines wordsOf(const std::string& text) {
  std::istringstream stream(text);
  TextLines words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

// Libraries that each room is linked with, by patina_module() of its CMakeLists.txt.
std::map<std::string, TextLines> dependencies() {
  const std::regex call(R"(patina_module\((\w+))"), list(R"(DEPENDS((\s+[a-z]+)+))");
  std::map<std::string, TextLines> rooms;
  for (const SourceFile& file : filesUnder({"modules"}, isCode)) {
    std::smatch found, depends;
    if (!file.path.ends_with("CMakeLists.txt") || file.path == "modules/CMakeLists.txt" ||
        !std::regex_search(file.text, found, call))
      continue;
    const std::string arguments = found.suffix();
    TextLines& on = rooms[found[1]];
    if (std::regex_search(arguments, depends, list)) on = wordsOf(depends[1]);
  }
  return rooms;
}

int rowOf(const std::string& room, const std::map<std::string, TextLines>& rooms) {
  int row = 0;
  for (const std::string& other : rooms.at(room)) row = std::max(row, 1 + rowOf(other, rooms));
  return row;
}

struct Box {
  std::string name, caption;
  TextLines lines; // the highest floor first
};

TextLines linesOf(const std::string& place, const Floors& floors) {
  TextLines lines;
  const auto room = floors.find(place);
  if (room == floors.end()) return lines;
  std::map<int, std::string> by_floor;
  for (const auto& [folder, floor] : room->second)
    if (folder != ".") by_floor[floor] += (by_floor[floor].empty() ? "" : ", ") + folder;
  for (auto floor = by_floor.rbegin(); floor != by_floor.rend(); ++floor)
    lines.push_back(floor->second);
  return lines;
}

std::string joined(const TextLines& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string svgText(int x, int y, const std::string& kind, const std::string& text) {
  return "<text x=\"" + std::to_string(x) + "\" y=\"" + std::to_string(y) + "\" class=\"" + kind +
         "\">" + text + "</text>\n";
}

int heightOf(const std::vector<Box>& row) {
  std::size_t most = 0;
  for (const Box& box : row) most = std::max(most, box.lines.size());
  return kTitle + kLine * static_cast<int>(most + 1) + 8;
}

std::string drawn(const std::vector<Box>& row, int y) {
  std::string svg;
  const int count = static_cast<int>(row.size());
  const int width = (kWidth - kGap * (count + 1)) / count, height = heightOf(row);
  for (int i = 0; i < count; ++i) {
    const Box& box = row[static_cast<std::size_t>(i)];
    const int x = kGap + i * (width + kGap);
    svg += "<rect x=\"" + std::to_string(x) + "\" y=\"" + std::to_string(y) + "\" width=\"" +
           std::to_string(width) + "\" height=\"" + std::to_string(height) + "\"/>\n";
    svg += svgText(x + 8, y + 17, "room", box.name);
    int line = y + 17 + kLine;
    svg += svgText(x + 8, line, "on", box.caption);
    for (const std::string& text : box.lines) svg += svgText(x + 8, line += kLine, "floor", text);
  }
  return svg;
}

} // namespace

std::string planPicture() {
  const Floors floors = floorsIn(textOfFile("modules/floors.txt"));
  const std::map<std::string, TextLines> rooms = dependencies();
  std::map<int, std::vector<Box>> rows;
  int top = 0;
  for (const auto& [room, on] : rooms) {
    const int row = rowOf(room, rooms);
    top = std::max(top, row + 1);
    rows[row].push_back(
        {room, on.empty() ? "" : "uses " + joined(on), linesOf("modules/" + room, floors)});
  }
  for (const char* program : {"cli", "gui", "studies"})
    rows[top].push_back(
        {std::string("app/") + program, "", linesOf(std::string("app/") + program, floors)});
  std::string body;
  int y = kGap;
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    body += drawn(row->second, y);
    y += heightOf(row->second) + kGap;
  }
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + std::to_string(kWidth) +
         "\" height=\"" + std::to_string(y) + "\" viewBox=\"0 0 " + std::to_string(kWidth) + " " +
         std::to_string(y) +
         "\">\n<style>rect{fill:#f6f8fa;stroke:#57606a}text{font-family:sans-serif;fill:#24292f}"
         ".room{font-size:14px;font-weight:bold}.on{font-size:11px;fill:#57606a}"
         ".floor{font-size:12px}</style>\n<rect width=\"100%\" height=\"100%\" "
         "style=\"fill:#ffffff;stroke:none\"/>\n" +
         body + "</svg>\n";
}

} // namespace patina::architecture
