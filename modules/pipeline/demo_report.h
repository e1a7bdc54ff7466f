// What the demonstration found, for a person and for a program, with what each figure must hold.
#pragma once

#include <string>
#include <vector>

#include "core/json.h"
#include "pipeline/demo.h"

namespace patina {

struct DemoFigure {
  std::string step, what, of;                  // `of`: a material, or empty
  double value = 0, most = 0;                  // SI
  std::string unit;                            // "m", "dB", "" for a ratio
  bool holds() const { return value <= most; } // not where it is no number
};
// Errors against the truth, of the steps that ran.
std::vector<DemoFigure> demoFigures(const Demo& demo);

Json demoJson(const Demo& demo);
std::string demoMarkdown(const Demo& demo, const std::vector<std::string>& pictures);

// Pictures of every step into the demo's folder; their names. Throws Error without a display.
std::vector<std::string> drawDemo(const Demo& demo);

} // namespace patina
