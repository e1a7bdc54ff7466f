// How the words of a picture look: as large as the picture asks for, and legible on its ground.
#pragma once

#include <vtkRenderWindow.h>
#include <vtkTextProperty.h>

#include "visualization/values/palette.h"

namespace patina {

struct Lettering {
  int size = 13;   // what VTK is asked for: of a pixel that is 1/72 inch
  int pixels = 13; // as it is drawn, on a screen with finer ones
  palette::Ground ground = palette::kLight;
};

// Readable in a window, and in proportion in a large picture.
Lettering letteringOf(vtkRenderWindow* window, const palette::Ground& ground);

// Relative luminances of two colours against one another (WCAG 2.1): 1 = none, 21 = black on white.
double contrastOf(const palette::Color& a, const palette::Color& b);
// The colour, with as much of the ground's text as it takes to have a contrast of 4.5 to its plate.
palette::Color legible(const palette::Color& color, const palette::Ground& ground);

// Family, size, colour; on an opaque plate of the ground where it is asked for.
void write(vtkTextProperty& text, const Lettering& lettering, const palette::Color& color,
           bool plate);

} // namespace patina
