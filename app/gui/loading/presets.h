// Scenes that the program makes itself, to begin with.
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
const std::vector<Preset>& presets(); // the first is what opens where nothing is named

QPixmap pictureOf(const Preset& preset);
Scene presetScene(const std::string& name); // of one of them
const Preset& presetNamed(const std::string& name);

} // namespace patina
