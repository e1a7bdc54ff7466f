// Icons that are drawn in code and thus sharp at every scale.
#pragma once

#include <QIcon>

namespace patina {

// Draws in a square of 20 units, with a pen of the text colour. `steps` are separated by
// semicolons:
//   line X Y ...            a line through points
//   polygon X Y ...         a closed one
//   curve X Y ...           cubic curves, each with two control points and an end
//   blob X Y ...            closed ones
//   ellipse X Y RX RY       by its centre
//   box X Y WIDTH HEIGHT R  R: radius of the corners, may be absent
//   round COLOUR WIDTH      a pen with round ends; square: with square ends; soft: round corners,
//   too fill COLOUR             a brush; COLOUR: of the theme, darker in per cent behind a slash,
//   or #... turn DEGREES            about the middle, until `back`
QIcon drawnIcon(const char* steps);

} // namespace patina
