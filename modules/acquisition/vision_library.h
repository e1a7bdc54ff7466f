// The library that holds OpenCV, loaded when it is first asked for.
#pragma once

#include "acquisition/vision/vision.h"

namespace patina {

// Throws Error saying what is missing and where it was looked for.
const VisionLibrary& visionLibrary();

} // namespace patina
