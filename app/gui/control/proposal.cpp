#include "app/gui/control/proposal.h"

#include "app/gui/toolkit/words.h"

namespace patina {
namespace {

constexpr double kTipRadius = 1e-3; // [m], that of the warning about open parts

struct Row {
  const char *part, *words; // the warning's; the button's
  void (*change)(Scene&);
};
constexpr Row kRows[] = {{"a part that stays open is felt from its front", "Feel both sides",
                          [](Scene& scene) {
                            scene.field.sides = OpenSides::two;
                            if (!scene.haptics.tip_radius) scene.haptics.tip_radius = kTipRadius;
                          }},
                         {"surface.sides = one has no effect", "Set it to automatic",
                          [](Scene& scene) { scene.field.sides = OpenSides::automatic; }},
                         {"surface.sides = two has no effect", "Set it to automatic",
                          [](Scene& scene) { scene.field.sides = OpenSides::automatic; }},
                         {"too sharp for this device to render stably as a layer", "Couple it",
                          [](Scene& scene) { scene.haptics.texture_gain.reset(); }},
                         {"magnet.range has no effect", "Remove the magnet",
                          [](Scene& scene) { scene.haptics.magnet.reset(); }},
                         {"magnet.strength has no effect", "Remove the magnet",
                          [](Scene& scene) { scene.haptics.magnet.reset(); }}};

} // namespace

std::optional<Proposal> proposalOf(const QString& warning) {
  for (const Row& row : kRows)
    if (warning.contains(QString::fromUtf8(row.part))) return Proposal{tr(row.words), row.change};
  return std::nullopt;
}

} // namespace patina
