// The hand of the tour: moves the tip and paints, as a person would.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "app/gui/window/main_window.h"

namespace patina {

// A widget by what it is, and by its name where there are several.
template <typename Widget> Widget& find(MainWindow& window, const char* name = nullptr) {
  return *window.findChild<Widget*>(QString::fromUtf8(name));
}

// Targets, one every few milliseconds. A thread of its own plays them, so that the path does not
// depend on how fast this machine draws.
void play(MainWindow& window, const std::vector<Vec3>& targets);

// Places are in fractions of the picture's height from its centre.
// Somewhere near the middle there is surface, whatever the mesh; throws Error if not.
Vec2 placeToTouch(MainWindow& window);
// From the air onto the surface and in by `depth`.
void press(MainWindow& window, const Vec2& place, double depth, int milliseconds);
// Along the surface, the depth below it swaying as a stroking hand's does.
void slide(MainWindow& window, const Vec2& from, const Vec2& to, double depth, int milliseconds);
// One stroke with the tool that is chosen; at(0 .. 1). `at_last`: before the hand lifts. Waits
// until the stroke is in the history; throws Error if nothing was painted.
void paintAlong(MainWindow& window, const std::function<Vec2(double)>& at, int milliseconds,
                const std::function<void()>& at_last = {});

} // namespace patina
