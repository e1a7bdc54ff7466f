// Pictures and cameras that are turned by one of EXIF's eight orientations: 1 leaves the picture as
// it is stored, 3 turns it by 180 degrees, 6 by 90 degrees clockwise, 8 by 90 degrees
// anticlockwise; 2 4 5 7 are the mirrored ones.
#pragma once

#include "acquisition/values/camera.h"

namespace patina {

// Returns the picture as it is shown.
GreyFrame turned(GreyFrame stored, int orientation);
// Returns the camera of the shown picture, given that of the stored one. Throws Error for a sensor
// that is tilted about two axes: no coefficients describe its mirror image.
Camera turned(const Camera& stored, int orientation);
// Convert a pixel of the shown picture to the stored one, and back.
Vec2 storedPixel(const Vec2& shown, const GreyFrame& picture);
Vec2 shownPixel(const Vec2& stored, const GreyFrame& picture);

// Returns true if width and height are exchanged.
inline bool isTransposed(int orientation) {
  return orientation >= 5;
}

// Returns the camera of a picture: `camera` itself if the shown picture has its size, the turned
// camera if the stored picture has. Throws FileError if neither has.
Camera cameraOf(const GreyFrame& image, const Camera& camera, const std::string& name);
// Throws FileError if the size of the image differs from that of the calibration.
void requireSize(const GreyFrame& image, const Camera& camera, const std::string& name);

// Summary of the frames that were turned.
class TurnedFrames {
 public:
  void add(const GreyFrame& image, const std::string& name);
  // Returns one line, or an empty text if no frame was turned. `camera` is the file's camera that
  // was turned too, or nullptr. `unlike` is the remark for frames of different orientations.
  std::string line(const Camera* camera, const std::string& unlike) const;

 private:
  std::size_t frames_ = 0, turned_ = 0;
  int orientation_ = 1, first_ = 1;
  std::string name_, other_; // first turned frame; first one with another orientation
};

// Remark for tracked frames.
inline constexpr const char* kTurnedUnlike =
    "poses are right if only the files differ, wrong if the camera was turned";

} // namespace patina
