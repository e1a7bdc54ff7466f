#include "app/gui/control/object_edits.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numbers.h"

namespace patina {
namespace {

auto find(const std::vector<SceneObject>& list, const std::string& name) {
  return std::find_if(list.begin(), list.end(),
                      [&](const SceneObject& object) { return object.name == name; });
}

// "turn cup by 30° about z", "move cup by 12 mm"; both at once are a move.
std::string wordsFor(const SceneObject& object, const Pose& now) {
  const Pose& before = object.world_from_object;
  const double way = (now.translation() - before.translation()).norm();
  if (way > 0) return "move " + object.name + " by " + formatLength(way);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(now.linear() * before.linear().transpose()));
  std::string words = "turn " + object.name + " by " +
                      formatNumber(std::round(turn.angle() * 1800 / M_PI) / 10) + "°";
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(turn.axis()[axis]) > 0.9999) words += std::string(" about ") + "xyz"[axis];
  return words;
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
      return wordsFor(object, now->world_from_object);
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
