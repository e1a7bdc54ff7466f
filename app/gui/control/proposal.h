// The change of the scene that a warning proposes, if it proposes one alone.
#pragma once

#include <functional>
#include <optional>

#include <QString>

#include "scene/scene.h"

namespace patina {

struct Proposal {
  QString words; // the button's
  std::function<void(Scene&)> change;
};

// `warning`: a line of openScene() or compileWarnings(). nullopt: none, or several ways to choose
// from.
std::optional<Proposal> proposalOf(const QString& warning);

} // namespace patina
