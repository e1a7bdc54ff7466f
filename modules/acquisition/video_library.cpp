#include "acquisition/video_library.h"

#include <cstdlib>

#include "core/error.h"
#include "core/loaded_library.h"
#include "core/memory_left.h"

namespace patina {

const VideoLibrary& videoLibrary() {
  static std::string video_cause;
  static void* const video_symbol = [] {
    requireRoomToLoad("the library of video");
    // Read while it loads: FFmpeg's lines on the console say nothing that an Error does not, and a
    // camera that sends nothing is given up sooner.
    ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
    ::setenv("OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT", "1", 0);
    return loadedSymbol("patina_video.so", kVideoLibrarySymbol, video_cause);
  }();
  if (!video_symbol)
    throw Error("videos and cameras need Patina's library of video, which cannot be loaded: " +
                video_cause);
  return *reinterpret_cast<VideoLibraryFunction*>(video_symbol)();
}

} // namespace patina
