// The library that holds OpenCV's readers of videos and cameras, loaded when it is first asked for.
#pragma once

#include "acquisition/video/video.h"

namespace patina {

// Throws Error saying what is missing and where it was looked for.
const VideoLibrary& videoLibrary();

} // namespace patina
