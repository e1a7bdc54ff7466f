#include "session/edit/value_edit.h"

#include <algorithm>

#include "scene/scene_values.h"
namespace patina {
namespace {

using List = std::vector<std::pair<std::string, std::string>>;

const std::string* find(const List& list, const std::string& key) {
  const auto at =
      std::find_if(list.begin(), list.end(), [&](const auto& item) { return item.first == key; });
  return at == list.end() ? nullptr : &at->second;
}

} // namespace

std::optional<ValueEdit> valueEdit(const Scene& before, const Scene& after) {
  const List old = values(before), now = values(after);
  ValueEdit edit;
  // Removed keys come first: a new value replaces its mutually exclusive counterpart.
  for (const auto& [key, value] : old)
    if (!find(now, key) && !(key == "resolution" && find(now, "voxel")))
      edit.values.emplace_back(key, sceneKey(key).default_value);
  for (const auto& [key, value] : now) {
    const std::string* earlier = find(old, key);
    if (!earlier || *earlier != value) edit.values.emplace_back(key, value);
  }
  if (edit.values.empty()) return std::nullopt;
  return edit;
}

ValueEdit merged(const ValueEdit& first, const ValueEdit& then) {
  ValueEdit edit;
  for (const auto& item : first.values)
    if (!find(then.values, item.first)) edit.values.push_back(item);
  edit.values.insert(edit.values.end(), then.values.begin(), then.values.end());
  return edit;
}

} // namespace patina
