#include "app/gui/loading/presets.h"

#include <algorithm>

#include <QCoreApplication>

#include "field/surface/models.h"
#include "geometry/mesh/shapes.h"
#include "session/build/session.h"

void initPresetPictures() {
  Q_INIT_RESOURCE(presets); // of a static library
}

namespace patina {
namespace {

QString said(const char* words) {
  return QCoreApplication::translate("Presets", words);
}

} // namespace

const std::vector<Preset>& presets() {
  static const std::vector<Preset> kAll = {
      {"dinosaur", said("Toy dinosaur"), said("One smooth closed surface, 100 mm long")},
      {"pottery", said("Vase with friction"), said("Thin-walled, felt 1 mm outside its surface")},
      {"galleon", said("Ship of thin sheets"), said("Open sheets, felt from both sides")},
      {"ball", said("Ball"), said("A round of 30 mm: the plainest thing to feel and paint on")}};
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
