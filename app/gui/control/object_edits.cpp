#include "app/gui/control/object_edits.h"

#include <algorithm>
#include <utility>

namespace patina {
namespace {

auto find(const std::vector<SceneObject>& list, const std::string& name) {
  return std::find_if(list.begin(), list.end(),
                      [&](const SceneObject& object) { return object.name == name; });
}

} // namespace

bool sameObjects(const std::vector<SceneObject>& a, const std::vector<SceneObject>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const SceneObject& left, const SceneObject& right) {
                      return left.name == right.name && left.mesh == right.mesh &&
                             left.world_from_object.matrix() == right.world_from_object.matrix();
                    });
}

std::vector<SceneObject> withEdits(const std::vector<SceneObject>& now,
                                   const std::vector<SceneObject>& before,
                                   const std::vector<SceneObject>& edited) {
  std::vector<SceneObject> result;
  for (const SceneObject& object : now) {
    const auto known = find(edited, object.name);
    if (known == edited.end() && find(before, object.name) != before.end()) continue;
    result.push_back(object);
    if (known != edited.end()) result.back().world_from_object = known->world_from_object;
  }
  return result;
}

std::string wordsFor(const std::vector<SceneObject>& before,
                     const std::vector<SceneObject>& edited) {
  for (const SceneObject& object : before) {
    const auto now = find(edited, object.name);
    if (now == edited.end()) return "remove " + object.name;
    if (now->world_from_object.matrix() != object.world_from_object.matrix())
      return "move " + object.name;
  }
  return {};
}

Scene withAdded(Scene scene, const std::vector<SceneObject>& objects) {
  for (SceneObject object : objects) {
    const std::string name = object.name;
    for (int number = 2; find(scene.objects, object.name) != scene.objects.end(); ++number)
      object.name = name + "-" + std::to_string(number);
    scene.objects.push_back(std::move(object));
  }
  return scene;
}

} // namespace patina
