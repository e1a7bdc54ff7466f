#include "visualization/values/text_style.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

double luminanceOf(const palette::Color& color) {
  const auto linear = [](double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(color[0]) + 0.7152 * linear(color[1]) + 0.0722 * linear(color[2]);
}

} // namespace

TextStyle textStyleOf(vtkRenderWindow* window, const palette::BackgroundStyle& ground) {
  TextStyle made;
  made.ground = ground;
  if (window == nullptr) return made;
  const double scale = std::max(1.0, window->GetDPI() / 72.0);
  made.size = std::max(13, static_cast<int>(window->GetSize()[1] / scale) / 60);
  made.pixels = static_cast<int>(std::lround(scale * made.size));
  return made;
}

double contrastOf(const palette::Color& a, const palette::Color& b) {
  const auto [dark, bright] = std::minmax({luminanceOf(a), luminanceOf(b)});
  return (bright + 0.05) / (dark + 0.05);
}

palette::Color legible(const palette::Color& color, const palette::BackgroundStyle& ground) {
  // min contrast; above 4.5, because drawn colours are rounded and smoothed
  constexpr double kEnough = 4.7;
  const bool darker = luminanceOf(ground.text) < luminanceOf(ground.text_background);
  const palette::Color goal = darker ? palette::Color{} : ground.text; // black keeps the hue
  palette::Color made = color;
  for (int step = 1; step <= 20 && contrastOf(made, ground.text_background) < kEnough; ++step)
    for (std::size_t c = 0; c < 3; ++c) made[c] = color[c] + step / 20.0 * (goal[c] - color[c]);
  return made;
}

void write(vtkTextProperty& text, const TextStyle& style, const palette::Color& color,
           bool text_background) {
  text.SetFontFamilyToArial();
  text.SetFontSize(style.size);
  text.SetColor(palette::forVtk(legible(color, style.ground)));
  text.SetBackgroundColor(palette::forVtk(style.ground.text_background));
  text.SetBackgroundOpacity(text_background && style.ground.plates ? 1 : 0);
}

} // namespace patina
