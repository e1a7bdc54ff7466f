#include "app/cli/framework/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "core/numbers.h"

namespace patina::cli {

namespace {

bool isNothing(const Json& value) {
  if (value.isNumber()) return value.asNumber() == 0;
  if (value.isBool()) return !value.asBool();
  if (value.isString()) return value.asString().empty();
  if (value.isArray()) return value.asArray().empty();
  return value.isNull();
}

} // namespace

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::string rounded(double value) {
  const double size = std::abs(value);
  if (size >= 999.5)
    return (value < 0 ? "-" : "") + formatCount(static_cast<std::size_t>(size + 0.5));
  const int digits = size >= 99.95 ? 0 : size >= 9.995 ? 1 : size >= 0.9995 ? 2 : 3;
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string shown(const Json& value, const std::string& unit) {
  if (value.isBool()) return value.asBool() ? "yes" : "no";
  if (value.isString()) return value.asString();
  if (value.isArray()) {
    std::vector<std::string> words;
    for (const Json& item : value.asArray()) words.push_back(shown(item, unit));
    return joined(words);
  }
  if (!value.isNumber()) return "none";
  const double number = value.asNumber();
  if (unit == "m") return formatLength(number);
  if (unit == "B") return formatBytes(number);
  if (unit.empty() && number >= 0 && number == std::floor(number))
    return formatCount(static_cast<std::size_t>(number));
  return rounded(number) + (unit.empty() ? "" : " " + unit);
}

const Key& Report::declared(std::string_view name) const {
  const auto key = std::find_if(keys_->begin(), keys_->end(),
                                [&](const Key& candidate) { return candidate.name == name; });
  if (key == keys_->end())
    throw std::invalid_argument("report: the key " + std::string(name) + " is not declared");
  return *key;
}

Report& Report::set(std::string_view name, Json value) {
  std::string text = shown(value, declared(name).unit);
  return set(name, std::move(value), text);
}

Report& Report::set(std::string_view name, Json value, const std::string& text) {
  const Key& key = declared(name);
  if (key.shown == Shown::always || (key.shown == Shown::if_any && !isNothing(value)))
    tell(key.caption, text);
  json_.set(name, std::move(value));
  return *this;
}

Report& Report::set(std::string_view name, const Report& part) {
  (void)declared(name);
  json_.set(name, part.json_);
  rows_.insert(rows_.end(), part.rows_.begin(), part.rows_.end());
  return *this;
}

Report& Report::set(std::string_view name, const std::vector<Report>& list) {
  const Key& key = declared(name);
  Json entries = Json::array();
  for (const Report& entry : list) {
    entries.push(entry.json_);
    if (key.shown == Shown::never || entry.rows_.empty()) continue;
    std::vector<std::string> values;
    for (const auto& [caption, text] : entry.rows_) values.push_back(text);
    const std::string label = values.front();
    values.erase(values.begin());
    tell(key.caption + " " + label, joined(values, "; "));
  }
  json_.set(name, std::move(entries));
  return *this;
}

Report& Report::tell(const std::string& caption, const std::string& text) {
  rows_.emplace_back(caption, text);
  return *this;
}

std::string Report::text() const {
  std::size_t width = 0;
  for (const auto& [caption, value] : rows_) width = std::max(width, caption.size());
  std::string text;
  for (const auto& [caption, value] : rows_)
    text += caption + std::string(width - caption.size() + 2, ' ') + value + "\n";
  return text;
}

} // namespace patina::cli
