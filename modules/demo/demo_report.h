// What the demonstration found, for a person and for a program, with what each figure must hold.
#pragma once

#include <string>
#include <vector>

#include "core/json.h"
#include "demo/demo.h"

namespace patina {

struct DemoFigure {
  std::string step, what, of;                  // `of`: a material, or empty
  double value = 0, most = 0;                  // SI
  std::string unit;                            // "m", "dB", "" for a ratio
  bool holds() const { return value <= most; } // not where it is no number
};
// "0.08 mm", "0.52 dB", "14.9 %" for a value in the unit of a figure.
std::string figureText(double value, const std::string& unit);
// Errors against the truth, of the steps that ran.
std::vector<DemoFigure> demoFigures(const Demo& demo);

Json demoJson(const Demo& demo);
std::string demoMarkdown(const Demo& demo, const std::vector<std::string>& pictures);

} // namespace patina
