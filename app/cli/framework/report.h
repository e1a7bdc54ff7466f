// Report of a command: the text rows, the object of --json and, by the declared keys, the list in
// --help come from one definition.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/json.h"

namespace patina::cli {

// When the text shows a row; if_any: unless it is zero, empty, false or null.
enum class Shown : std::uint8_t { always, if_any, never };

struct Key {
  std::string name;       // name in --json
  std::string unit;       // unit of the number; "B" for bytes, empty for counts and words
  std::string caption;    // caption of the row and in --help
  std::string about = {}; // addition for --help
  Shown shown = Shown::always;
  std::vector<Key> parts = {}; // keys of an object, or of each object in a list, for --help
};
using Keys = std::vector<Key>;

using TextRows = std::vector<std::pair<std::string, std::string>>;

class Report {
 public:
  // `keys` must outlive the report. Setting an undeclared key throws std::invalid_argument. A key
  // that is not set is left out.
  explicit Report(const Keys& keys) : keys_(&keys) {}

  // The text shows the value with its unit, or `text`.
  Report& set(std::string_view name, Json value);
  Report& set(std::string_view name, Json value, const std::string& text);
  // An object; its rows are added to these.
  Report& set(std::string_view name, const Report& part);
  // A list of objects, one row each, named by their first key.
  Report& set(std::string_view name, const std::vector<Report>& list);
  // Adds a row to the text only.
  Report& tell(const std::string& caption, const std::string& text);

  const Json& json() const { return json_; }
  std::string text() const; // aligned "caption   value" lines

 private:
  const Key& declared(std::string_view name) const;

  const Keys* keys_;
  Json json_ = Json::object();
  TextRows rows_;
};

// Formats a value: "800 N/m", "0.75 mm", "12.3 MB", "1,411", "yes", "mesh, color".
std::string shown(const Json& value, const std::string& unit);
// Three significant digits without an exponent ("0.8", "28.1", "1,411").
std::string rounded(double value);
std::string joined(const std::vector<std::string>& words, const char* between = ", ");

} // namespace patina::cli
