// Report of the demonstration as text and JSON, with a limit for each figure.
#pragma once

#include <string>
#include <vector>

#include "core/json.h"
#include "demo/demo.h"

namespace patina {

struct DemoFigure {
  std::string step, what, of;                    // `of`: a material, or empty
  double value = 0, limit = 0;                   // SI
  std::string unit;                              // "m", "dB", "" for a ratio
  bool passes() const { return value <= limit; } // false for NaN
};
// Formats a value in a figure's unit: "0.08 mm", "0.52 dB", "14.9 %".
std::string figureText(double value, const std::string& unit);
// Errors against the ground truth, of the finished steps.
std::vector<DemoFigure> demoFigures(const Demo& demo);

Json demoJson(const Demo& demo);
std::string demoMarkdown(const Demo& demo, const std::vector<std::string>& pictures);

} // namespace patina
