// What a person did to the list of objects, as edits of a scene that may have changed meanwhile.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace patina {

// The same names, meshes and places; paint is not looked at.
bool sameObjects(const std::vector<SceneObject>& a, const std::vector<SceneObject>& b);

// `now`, with what a person has moved and removed since it was `before`: an object that was added
// meanwhile, and what was painted, stays.
std::vector<SceneObject> withEdits(const std::vector<SceneObject>& now,
                                   const std::vector<SceneObject>& before,
                                   const std::vector<SceneObject>& edited);

// "move cup by 12 mm", for the history; empty: neither moved nor removed.
std::string wordsFor(const std::vector<SceneObject>& before,
                     const std::vector<SceneObject>& edited);

// With objects that get names of their own: "cup", "cup-2", "cup-3".
Scene withAdded(Scene scene, const std::vector<SceneObject>& objects);

} // namespace patina
