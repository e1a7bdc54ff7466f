// Tables {value, text} of the words that files, commands and messages use for values.
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

// Returns an empty text if the table lacks the value.
template <typename Table, typename T>
constexpr std::string_view nameIn(const Table& table, const T& value) {
  for (const auto& row : table)
    if (row.value == value) return row.text;
  return {};
}

template <typename Table> auto parseIn(const Table& table, std::string_view text) {
  std::optional<decltype(table[0].value)> found;
  for (const auto& row : table)
    if (row.text == text) found = row.value;
  return found;
}

// Returns all words as "a, b or c"; `last` separates the last one.
template <typename Table> std::string allNames(const Table& table, std::string_view last = ", ") {
  std::string all;
  for (std::size_t i = 0, n = std::size(table); i < n; ++i)
    all.append(i == 0 ? "" : i + 1 == n ? last : ", ").append(table[i].text);
  return all;
}

} // namespace patina
