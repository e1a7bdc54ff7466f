// Text style of a picture: size for the picture, contrast for its background.
#pragma once

#include <vtkRenderWindow.h>
#include <vtkTextProperty.h>

#include "visualization/values/palette.h"

namespace patina {

struct TextStyle {
  int size = 13;   // VTK font size, in pixels of 1/72 inch
  int pixels = 13; // size as drawn on a high-resolution screen
  palette::BackgroundStyle ground = palette::kLight;
};

// Size that is readable in a window and proportional in a large picture.
TextStyle textStyleOf(vtkRenderWindow* window, const palette::BackgroundStyle& ground);

// Contrast ratio of two colours (WCAG 2.1): 1 = none, 21 = black on white.
double contrastOf(const palette::Color& a, const palette::Color& b);
// Mixes the colour with the text colour until its contrast to the text background is 4.5.
palette::Color legible(const palette::Color& color, const palette::BackgroundStyle& ground);

// Sets family, size and colour, optionally on an opaque background.
void write(vtkTextProperty& text, const TextStyle& style, const palette::Color& color,
           bool text_background);

} // namespace patina
