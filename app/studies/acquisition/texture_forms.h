// The forms in which a texture may be summed, against sums in more digits than a double has.
#pragma once

#include <vector>

#include "acquisition/profile/height_profile.h"
#include "app/studies/study.h"

namespace patina {

// A profile as a milling cutter leaves it, 28 mm long, in steps of 5 um.
std::vector<ProfilePoint> milledPoints(std::uint32_t seed);

// Of 128 harmonics over x, one period, a million and a billion away (T-A19d).
WorkPrecisionTable lineForms(const StudyOptions& options, Progress& progress);
// Over x and y: of products, whose plane all forms can sum (A21).
WorkPrecisionTable planeForms(const StudyOptions& options, Progress& progress);

} // namespace patina
