// Values and their words, as files, commands and messages have them: a table {value, text}.
#pragma once

#include <iterator>
#include <optional>
#include <string>
#include <string_view>

namespace patina {

template <typename T> struct Named {
  T value;
  std::string_view text;
};

// Empty where the table lacks it.
template <typename Table, typename T>
constexpr std::string_view textIn(const Table& table, const T& value) {
  for (const auto& row : table)
    if (row.value == value) return row.text;
  return {};
}

template <typename Table> auto valueIn(const Table& table, std::string_view text) {
  std::optional<decltype(table[0].value)> found;
  for (const auto& row : table)
    if (row.text == text) found = row.value;
  return found;
}

// "a, b or c": all its words, `last` before the last.
template <typename Table> std::string textsOf(const Table& table, std::string_view last = ", ") {
  std::string all;
  for (std::size_t i = 0, n = std::size(table); i < n; ++i)
    all.append(i == 0 ? "" : i + 1 == n ? last : ", ").append(table[i].text);
  return all;
}

} // namespace patina
