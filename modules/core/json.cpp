#include "core/json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

// Limits the recursion of a value's destructor; deeper text is hostile or broken.
constexpr std::size_t kMaxDepth = 200;
constexpr std::size_t kMaxBytes = std::size_t{1} << 30;

std::size_t lineAt(std::string_view text, std::size_t offset) {
  std::size_t line = 1;
  for (std::size_t i = 0; i < offset && i < text.size(); ++i) line += text[i] == '\n' ? 1 : 0;
  return line;
}

std::string printable(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

} // namespace

struct JsonSeam {
  static const char* kind(const Json& json) {
    constexpr const char* kNames[] = {"null",   "number", "number", "true/false",
                                      "string", "array",  "object"};
    return kNames[json.value_.index()];
  }
  [[noreturn]] static void mismatch(const Json& json, const char* expected) {
    throw Error(std::string("expected ") + expected + ", found " + kind(json));
  }
  template <typename T> static const T& get(const Json& json, const char* expected) {
    if (const T* value = std::get_if<T>(&json.value_)) return *value;
    mismatch(json, expected);
  }
  static void write(const Json& json, int indent, int level, std::string& out);
};

namespace {

void writeString(const std::string& text, std::string& out) {
  // Uses the library's escaping; invalid UTF-8, as in file names, is replaced and does not throw.
  out += nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void newLine(int indent, int level, std::string& out) {
  if (indent < 0) return;
  out += '\n';
  out.append(static_cast<std::size_t>(indent) * static_cast<std::size_t>(level), ' ');
}

// Builds Json values directly, so that a hostile file never exists as the library's tree too.
class Builder : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  bool null() override { return add(Json()); }
  bool boolean(bool value) override { return add(Json(value)); }
  bool number_integer(number_integer_t value) override { return add(Json(std::int64_t{value})); }
  bool number_unsigned(number_unsigned_t value) override {
    if (value > static_cast<number_unsigned_t>(std::numeric_limits<std::int64_t>::max()))
      return add(Json(static_cast<double>(value)));
    return add(Json(static_cast<std::int64_t>(value)));
  }
  bool number_float(number_float_t, const string_t& digits) override {
    // The library's conversion depends on the locale.
    const std::optional<double> value = parseNumber(digits);
    return add(Json(value.value_or(std::numeric_limits<double>::quiet_NaN())));
  }
  bool string(string_t& value) override { return add(Json(std::move(value))); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool key(string_t& value) override {
    keys_.back() = std::move(value);
    return true;
  }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::json::exception&) override {
    const std::string shown = printable(token.substr(0, 40));
    throw FileError(name_, lineAt(text_, position > 0 ? position - 1 : 0),
                    position >= text_.size() ? "JSON ends too early"
                                             : "not JSON at '" + shown + "'");
  }

  Json root;

 private:
  bool add(Json value) {
    if (stack_.empty()) {
      root = std::move(value);
    } else if (stack_.back().isArray()) {
      stack_.back().push(std::move(value));
    } else {
      objects_.back().emplace_back(std::move(keys_.back()), std::move(value));
    }
    return true;
  }
  bool open(Json container) {
    if (stack_.size() >= kMaxDepth) throw FileError(name_, 0, "JSON is nested too deeply");
    stack_.push_back(std::move(container));
    keys_.emplace_back();
    objects_.emplace_back();
    return true;
  }
  // Readers would disagree about which of two equal keys counts.
  void requireEachKeyOnce(const Json::Object& members) const {
    std::vector<std::string_view> keys;
    keys.reserve(members.size());
    for (const auto& [key, value] : members) keys.push_back(key);
    std::sort(keys.begin(), keys.end());
    const auto twice = std::adjacent_find(keys.begin(), keys.end());
    if (twice != keys.end())
      throw FileError(name_, 0,
                      "the key '" + printable(std::string(*twice)) +
                          "' stands twice in one object; remove one of the two");
  }
  bool close() {
    if (stack_.back().isObject()) requireEachKeyOnce(objects_.back());
    Json value =
        stack_.back().isObject() ? Json(std::move(objects_.back())) : std::move(stack_.back());
    stack_.pop_back();
    keys_.pop_back();
    objects_.pop_back();
    return add(std::move(value));
  }

  std::string_view text_;
  const std::string& name_;
  std::vector<Json> stack_;
  // Collected here because set() would search for the key each time.
  std::vector<Json::Object> objects_;
  std::vector<std::string> keys_;
};

} // namespace

void JsonSeam::write(const Json& json, int indent, int level, std::string& out) {
  if (json.isNull()) {
    out += "null";
  } else if (json.isBool()) {
    out += json.asBool() ? "true" : "false";
  } else if (const double* number = std::get_if<double>(&json.value_)) {
    std::string digits = std::isfinite(*number) ? formatNumber(*number) : "null";
    // "-0" would be read back as an integer and lose its sign.
    if (std::isfinite(*number) && digits.find_first_of(".e") == std::string::npos) digits += ".0";
    out += digits;
  } else if (json.isNumber()) {
    out += std::to_string(json.asInteger());
  } else if (json.isString()) {
    writeString(json.asString(), out);
  } else if (json.isArray()) {
    out += '[';
    bool first = true;
    // Arrays of numbers stay on one line, so that a 4x4 matrix is written as four rows.
    bool flat = true;
    for (const Json& item : json.asArray()) flat = flat && !item.isArray() && !item.isObject();
    for (const Json& item : json.asArray()) {
      if (!first) out += indent >= 0 && flat ? ", " : ",";
      first = false;
      if (!flat) newLine(indent, level + 1, out);
      write(item, indent, level + 1, out);
    }
    if (!flat) newLine(indent, level, out);
    out += ']';
  } else {
    out += '{';
    bool first = true;
    for (const auto& [key, value] : json.asObject()) {
      if (!first) out += ',';
      first = false;
      newLine(indent, level + 1, out);
      writeString(key, out);
      out += indent < 0 ? ":" : ": ";
      write(value, indent, level + 1, out);
    }
    if (!first) newLine(indent, level, out);
    out += '}';
  }
}

bool Json::asBool() const {
  return JsonSeam::get<bool>(*this, "true/false");
}

double Json::asNumber() const {
  if (const auto* integer = std::get_if<std::int64_t>(&value_))
    return static_cast<double>(*integer);
  return JsonSeam::get<double>(*this, "number");
}

std::int64_t Json::asInteger() const {
  if (const auto* number = std::get_if<double>(&value_)) {
    // 2^63 is the first double that does not fit.
    if (*number == std::floor(*number) && std::abs(*number) < 0x1p63)
      return static_cast<std::int64_t>(*number);
    throw Error("expected whole number, found " + formatNumber(*number));
  }
  return JsonSeam::get<std::int64_t>(*this, "whole number");
}

const std::string& Json::asString() const {
  return JsonSeam::get<std::string>(*this, "string");
}
const Json::Array& Json::asArray() const {
  return JsonSeam::get<Array>(*this, "array");
}
const Json::Object& Json::asObject() const {
  return JsonSeam::get<Object>(*this, "object");
}

const Json* Json::find(std::string_view key) const {
  for (const auto& [name, value] : asObject())
    if (name == key) return &value;
  return nullptr;
}

const Json& Json::at(std::string_view key) const {
  if (const Json* value = find(key)) return *value;
  throw Error("'" + std::string(key) + "' is missing");
}

Json& Json::set(std::string_view key, Json value) {
  if (isNull()) value_ = Object{};
  if (!isObject()) JsonSeam::mismatch(*this, "object");
  Object& members = std::get<Object>(value_);
  for (auto& [name, old] : members) {
    if (name == key) {
      old = std::move(value);
      return *this;
    }
  }
  members.emplace_back(std::string(key), std::move(value));
  return *this;
}

void Json::push(Json value) {
  if (isNull()) value_ = Array{};
  if (!isArray()) JsonSeam::mismatch(*this, "array");
  std::get<Array>(value_).push_back(std::move(value));
}

std::string Json::dump(int indent) const {
  std::string out;
  JsonSeam::write(*this, indent, 0, out);
  return out;
}

Json parseJson(std::string_view text, const std::string& name) {
  if (text.size() > kMaxBytes) throw FileError(name, 0, "JSON is larger than 1 GB");
  Builder builder(text, name);
  try {
    if (!nlohmann::json::sax_parse(text.begin(), text.end(), &builder))
      throw FileError(name, 0, "not JSON");
  } catch (const nlohmann::json::exception&) {
    throw FileError(name, 0, "not JSON");
  }
  return std::move(builder.root);
}

} // namespace patina
