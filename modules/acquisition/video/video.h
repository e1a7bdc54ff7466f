// What the program asks of the library that holds OpenCV's readers of videos and cameras, apart
// from that of markers because it takes ten times as long to load. Both sides are built together,
// so that C++ types may cross; exceptions may not.
#pragma once

#include <memory>
#include <string>

#include "acquisition/camera.h"

namespace patina {

class VideoReader {
 public:
  virtual ~VideoReader() = default;
  // An empty text, or why it could not. `t` is when the camera took it, on the machine's steady
  // clock; of a file when its container has it shown, from the first picture on, and NaN where it
  // does not say [s].
  virtual std::string next(GreyFrame& image, double& t, bool& ended) = 0;

  double rate = 0; // [Hz], or one by a container's fine clock; 0: not said
  int count = 0;   // frames, as the file says; 0: not said
  // Once it has ended: how many pictures are in the file, shown or not, and how many of those that
  // are shown could not be decoded.
  int held = 0, lost = 0;
};

// Each returns an empty text, or why it could not.
struct VideoLibrary {
  std::string (*openFile)(const std::string& path, std::unique_ptr<VideoReader>& out);
  std::string (*openCamera)(int number, std::unique_ptr<VideoReader>& out);
};

// The one symbol that is looked up.
inline constexpr const char* kVideoLibrarySymbol = "patinaVideoLibrary";
using VideoLibraryFunction = const VideoLibrary*();

} // namespace patina
