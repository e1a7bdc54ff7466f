// A study's table for people, however many columns it has.
#pragma once

#include <string>

#include "core/work_precision.h"

namespace patina::cli {

constexpr std::size_t kTableWidth = 120;

// Columns aligned, at most `width` of them wide: what does not fit stands in a further block under
// the same settings. A column that never changes is told once, beside the title.
std::string foldedText(const WorkPrecisionTable& table, std::size_t width = kTableWidth);

} // namespace patina::cli
