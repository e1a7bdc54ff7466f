// Example scenes that the program generates.
#pragma once

#include <string>
#include <vector>

#include <QPixmap>
#include <QString>

#include "scene/scene.h"

namespace patina {

struct Preset {
  std::string name;
  QString words, tip;
};
const std::vector<Preset>& presets(); // The first is the default.

QPixmap pictureOf(const Preset& preset);
Scene presetScene(const std::string& name); // `name` must be one of presets().
const Preset& presetNamed(const std::string& name);

} // namespace patina
