// Any bytes give a value that reads back the same, or a FileError; asking it for what it is not
// gives an Error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/json.h"

namespace {

using patina::Json;

// Asks for one kind; says whether the value is of it.
template <typename Ask> bool holds(const Ask& ask) {
  try {
    ask();
    return true;
  } catch (const patina::Error&) {
    return false;
  }
}

// The same value made part by part, after each part was asked for all that it could be.
Json rebuilt(const Json& json) {
  const bool is_whole = holds([&] { (void)json.asInteger(); });
  if (holds([&] { (void)json.asBool(); }) != json.isBool() ||
      holds([&] { (void)json.asNumber(); }) != json.isNumber() ||
      holds([&] { (void)json.asString(); }) != json.isString() || (is_whole && !json.isNumber()) ||
      holds([&] { (void)json.at("a"); }) != (json.isObject() && json.find("a") != nullptr))
    std::abort();
  Json made;
  if (json.isArray()) {
    for (const Json& item : json.asArray()) made.push(rebuilt(item));
    if (made.isNull()) made = Json::array();
  } else if (json.isObject()) {
    for (const auto& [key, value] : json.asObject()) made.set(key, 0).set(key, rebuilt(value));
    if (made.isNull()) made = Json::object();
  } else {
    made = json;
    if (!json.isNull() && (holds([&] { made.push(Json()); }) || holds([&] { made.set("a", 0); })))
      std::abort();
  }
  return made;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Json json;
  try {
    json = patina::parseJson({reinterpret_cast<const char*>(data), size}, "fuzz");
  } catch (const patina::FileError&) {
    return 0;
  }
  for (const int indent : {-1, 2}) {
    const std::string text = json.dump(indent);
    if (patina::parseJson(text, "written").dump(indent) != text) std::abort();
    if (rebuilt(json).dump(indent) != text) std::abort();
  }
  return 0;
}
