// Pictures and cameras that were turned. How a picture is to be turned so that it is as it was seen
// is one of EXIF's eight orientations: 1 as it is stored, 3 by half a turn, 6 a quarter clockwise,
// 8 a quarter anticlockwise, 2 4 5 7 the same mirrored.
#pragma once

#include "acquisition/camera.h"

namespace patina {

// The picture as it is shown.
GreyFrame turned(GreyFrame stored, int orientation);
// The camera that sees as shown what `stored` sees as stored. Throws Error for a sensor that is
// tilted about two axes: no coefficients are those of its mirror image.
Camera turned(const Camera& stored, int orientation);
// Where a pixel of the picture as shown is stored, and back.
Vec2 storedPixel(const Vec2& shown, const GreyFrame& picture);
Vec2 shownPixel(const Vec2& stored, const GreyFrame& picture);

// Whether width and height change places.
inline bool isTransposed(int orientation) {
  return orientation >= 5;
}

// The camera of a picture: as its file has it where the picture as shown has its size, turned along
// with the picture where the picture as stored has. Throws FileError where neither has.
Camera cameraOf(const GreyFrame& image, const Camera& camera, const std::string& name);
// Throws FileError unless the image is as large as those that the camera was calibrated with.
void requireSize(const GreyFrame& image, const Camera& camera, const std::string& name);

// What is told of frames that were turned.
class TurnedFrames {
 public:
  void add(const GreyFrame& image, const std::string& name);
  // One line, or nothing where none was turned. `camera`: that was turned along, as its file has
  // it; or nullptr. `unlike`: what that means where not all were turned alike.
  std::string line(const Camera* camera, const std::string& unlike) const;

 private:
  std::size_t frames_ = 0, turned_ = 0;
  int orientation_ = 1, first_ = 1;
  std::string name_, other_; // of the first that was turned; and that is not turned as the first
};

// Of frames that are tracked.
inline constexpr const char* kTurnedUnlike =
    "poses are right if the files differ so, wrong if the camera was held so";

} // namespace patina
