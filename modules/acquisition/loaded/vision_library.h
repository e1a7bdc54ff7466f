// The library with OpenCV, loaded on first use.
#pragma once

#include "acquisition/loaded/vision.h"

namespace patina {

// Throws Error with the missing file and the places searched.
const VisionLibrary& visionLibrary();

} // namespace patina
