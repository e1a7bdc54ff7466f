#include "app/gui/loading/presets.h"

#include <algorithm>

#include "app/gui/toolkit/words.h"
#include "field/surface/models.h"
#include "geometry/mesh/shapes.h"
#include "session/open/session.h"

void initPresetPictures() {
  Q_INIT_RESOURCE(presets);
}

namespace patina {

const std::vector<Preset>& presets() {
  static const std::vector<Preset> kAll = {
      {"dinosaur", tr("Toy dinosaur"), tr("One smooth closed surface, 100 mm long")},
      {"pottery", tr("Vase with friction"), tr("Thin-walled, felt 1 mm outside its surface")},
      {"galleon", tr("Ship of thin sheets"), tr("Open sheets, felt from both sides")},
      {"ball", tr("Ball"), tr("A sphere of 30 mm: the simplest surface to feel and to paint on")}};
  return kAll;
}

const Preset& presetNamed(const std::string& name) {
  return *std::find_if(presets().begin(), presets().end(),
                       [&](const Preset& preset) { return preset.name == name; });
}

QPixmap pictureOf(const Preset& preset) {
  initPresetPictures();
  return QPixmap(QStringLiteral(":/presets/%1.png").arg(QString::fromStdString(preset.name)));
}

Scene presetScene(const std::string& name) {
  if (name == "pottery") {
    Scene scene = sceneOf(vase(), name);
    scene.haptics.stiffness = 800;
    scene.haptics.offset = 1e-3;
    scene.haptics.friction = Friction{.static_coefficient = 0.5, .dynamic_coefficient = 0.3};
    return scene;
  }
  if (name == "galleon") {
    Scene scene = sceneOf(galleon(0.1), name);
    scene.haptics.stiffness = 500;
    scene.haptics.offset = 1e-3;
    scene.field.sides = OpenSides::automatic_two;
    return scene;
  }
  if (name == "ball") return sceneOf(icosphere(0.03, 22), name);
  return sceneOf(dinosaur(), name);
}

} // namespace patina
