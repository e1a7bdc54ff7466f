#include <utility>

#include "core/error.h"
#include "scene/stroke.h"

namespace patina {

namespace {

// Returns the line of the given item of the list `strokes` in a JSON text; 0 if there is none.
std::size_t lineOfStroke(std::string_view text, std::size_t number) {
  std::size_t line = 1, depth = 0, seen = 0, begin = 0;
  std::string_view word; // last string outside every list and inner object
  bool quoted = false, in_list = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    line += c == '\n';
    if (quoted && c == '\\') {
      ++i;
    } else if (c == '"') {
      if (quoted && depth == 1) word = text.substr(begin, i - begin);
      quoted = !quoted;
      begin = i + 1;
    } else if (quoted) {
      continue;
    } else if (c == '{' || c == '[') {
      if (++depth == 2) in_list = word == "strokes";
      if (depth == 3 && in_list && ++seen == number) return line;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return 0;
}

} // namespace

std::vector<Stroke> parseStrokes(std::string_view text, const std::string& file) {
  const Json json = parseJson(text, file);
  std::vector<Stroke> strokes;
  try {
    const std::int64_t version = json.at("version").asInteger();
    if (version != 1)
      throw Error("strokes of version " + std::to_string(version) +
                  " are unknown; this program reads version 1");
    for (const Json& item : json.at("strokes").asArray()) {
      try {
        Stroke stroke = strokeFrom(item);
        requireSamples(stroke);
        strokes.push_back(std::move(stroke));
      } catch (const Error& error) {
        const std::size_t number = strokes.size() + 1;
        throw FileError(file, lineOfStroke(text, number),
                        "stroke " + std::to_string(number) + ": " + error.what());
      }
    }
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(file, 0, error.what());
  }
  return strokes;
}

Json toJson(const std::vector<Stroke>& strokes) {
  Json list = Json::array();
  for (const Stroke& stroke : strokes) list.push(toJson(stroke));
  Json json = Json::object();
  json.set("version", 1).set("strokes", std::move(list));
  return json;
}

} // namespace patina
