// What a command found, filled in once: the lines for people, the object of --json and, by the keys
// that are declared, the list in --help all come from it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/json.h"

namespace patina::cli {

// Whether people see a row; if_any: unless it is zero, empty, false or null.
enum class Shown : std::uint8_t { always, if_any, never };

struct Key {
  std::string name;       // of --json
  std::string unit;       // of its number; "B" for bytes, empty for counts and words
  std::string caption;    // of its row, and what --help says it is
  std::string about = {}; // what --help adds
  Shown shown = Shown::always;
  std::vector<Key> parts = {}; // of an object or of each object in a list, for --help
};
using Keys = std::vector<Key>;

using TextRows = std::vector<std::pair<std::string, std::string>>;

class Report {
 public:
  // `keys` must outlive the report. A key that is not among them is the caller's mistake: it throws
  // std::invalid_argument. One that is never set is left out.
  explicit Report(const Keys& keys) : keys_(&keys) {}

  // People read the value with its unit unless given a text.
  Report& set(std::string_view name, Json value);
  Report& set(std::string_view name, Json value, const std::string& text);
  // An object; its rows join these.
  Report& set(std::string_view name, const Report& part);
  // A list of objects, each a row: its first key names it, the others follow.
  Report& set(std::string_view name, const std::vector<Report>& list);
  // For people only.
  Report& tell(const std::string& caption, const std::string& text);

  const Json& json() const { return json_; }
  std::string text() const; // "caption   value" lines, the values aligned

 private:
  const Key& declared(std::string_view name) const;

  const Keys* keys_;
  Json json_ = Json::object();
  TextRows rows_;
};

// "800 N/m", "0.75 mm", "12.3 MB", "1,411", "yes", "mesh, color".
std::string shown(const Json& value, const std::string& unit);
// Three significant digits, never an exponent ("0.8", "28.1", "1,411").
std::string rounded(double value);
std::string joined(const std::vector<std::string>& words, const char* between = ", ");

} // namespace patina::cli
