// Interface of the library with OpenCV's video and camera readers, apart from the marker library
// because it takes ten times as long to load. Both sides are built together, so that C++ types may
// be passed; exceptions may not.
#pragma once

#include <memory>
#include <string>

#include "acquisition/values/camera.h"

namespace patina {

class VideoReader {
 public:
  virtual ~VideoReader() = default;
  // Returns an empty text, or the cause of the failure. `t` [s] is the steady clock's time at
  // which a camera took the frame; for a file, the container's presentation time from the first
  // picture on, or NaN if it has none.
  virtual std::string next(GreyFrame& image, double& t, bool& ended) = 0;

  double rate = 0; // [Hz], or the container's time base; 0: unknown
  int count = 0;   // frames according to the file; 0: unknown
  // After the end: all pictures in the file, and shown ones that could not be decoded.
  int held = 0, lost = 0;
};

// Each function returns an empty text, or the cause of the failure.
struct VideoLibrary {
  std::string (*openFile)(const std::string& path, std::unique_ptr<VideoReader>& out);
  std::string (*openCamera)(int number, std::unique_ptr<VideoReader>& out);
};

// The only symbol that is looked up.
inline constexpr const char* kVideoLibrarySymbol = "patinaVideoLibrary";
using VideoLibraryFunction = const VideoLibrary*();

} // namespace patina
