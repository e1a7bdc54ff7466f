// JSON as a plain value type. Only json.cpp includes the parsing library.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace patina {

class Json {
 public:
  using Array = std::vector<Json>;
  using Object = std::vector<std::pair<std::string, Json>>; // in insertion order

  Json() = default; // null
  Json(bool value) : value_(value) {}
  Json(double value) : value_(value) {} // a non-finite number is written as null
  Json(int value) : value_(std::int64_t{value}) {}
  Json(std::int64_t value) : value_(value) {}
  Json(std::size_t value) : value_(static_cast<std::int64_t>(value)) {}
  Json(const char* value) : value_(std::string(value)) {}
  Json(std::string value) : value_(std::move(value)) {}
  Json(std::string_view value) : value_(std::string(value)) {}
  Json(Array value) : value_(std::move(value)) {}
  Json(Object value) : value_(std::move(value)) {}
  static Json object() { return Json(Object{}); }
  static Json array() { return Json(Array{}); }

  bool isNull() const { return value_.index() == 0; }
  bool isBool() const { return std::holds_alternative<bool>(value_); }
  bool isNumber() const {
    return std::holds_alternative<double>(value_) || std::holds_alternative<std::int64_t>(value_);
  }
  bool isString() const { return std::holds_alternative<std::string>(value_); }
  bool isArray() const { return std::holds_alternative<Array>(value_); }
  bool isObject() const { return std::holds_alternative<Object>(value_); }

  // All throw patina::Error with the expected and the found kind.
  bool asBool() const;
  double asNumber() const;
  std::int64_t asInteger() const;
  const std::string& asString() const;
  const Array& asArray() const;
  const Object& asObject() const;

  // find() returns nullptr without the key, at() throws Error with it, set() appends or replaces.
  const Json* find(std::string_view key) const;
  const Json& at(std::string_view key) const;
  Json& set(std::string_view key, Json value);
  // Array access.
  void push(Json value);

  // Writes one line if indent < 0. Doubles read back bit for bit.
  std::string dump(int indent = 2) const;

 private:
  std::variant<std::monostate, double, std::int64_t, bool, std::string, Array, Object> value_;
  friend struct JsonSeam;
};

// Parses bounded depth and size, so that hostile text gives an error and never a crash. Throws
// FileError(name, line, cause), with the text's path as `name`.
Json parseJson(std::string_view text, const std::string& name);

} // namespace patina
