#include "acquisition/values/orientation.h"

#include <utility>

#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

// Returns true if the picture is mirrored horizontally (after the transposition, if any).
bool isFlippedAcross(int orientation) {
  return orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
}
bool isFlippedDown(int orientation) {
  return orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
}

std::string sizeOf(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

// Indices into OpenCV's list of coefficients.
enum Coefficient { kP1 = 2, kP2 = 3, kS1 = 8, kS2 = 9, kS3 = 10, kS4 = 11, kTauX = 12, kTauY = 13 };

} // namespace

Vec2 storedPixel(const Vec2& shown, const GreyFrame& picture) {
  Vec2 p = shown;
  if (isFlippedAcross(picture.orientation)) p.x() = picture.width - 1 - p.x();
  if (isFlippedDown(picture.orientation)) p.y() = picture.height - 1 - p.y();
  if (isTransposed(picture.orientation)) std::swap(p.x(), p.y());
  return p;
}

Vec2 shownPixel(const Vec2& stored, const GreyFrame& picture) {
  Vec2 p = stored;
  if (isTransposed(picture.orientation)) std::swap(p.x(), p.y());
  if (isFlippedAcross(picture.orientation)) p.x() = picture.width - 1 - p.x();
  if (isFlippedDown(picture.orientation)) p.y() = picture.height - 1 - p.y();
  return p;
}

GreyFrame turned(GreyFrame stored, int orientation) {
  if (orientation <= 1 || orientation > 8) return stored;
  const bool transposed = isTransposed(orientation);
  GreyFrame shown{transposed ? stored.height : stored.width,
                  transposed ? stored.width : stored.height,
                  {},
                  orientation};
  shown.pixel.reserve(stored.pixel.size());
  for (int y = 0; y < shown.height; ++y)
    for (int x = 0; x < shown.width; ++x) {
      int column = isFlippedAcross(orientation) ? shown.width - 1 - x : x,
          row = isFlippedDown(orientation) ? shown.height - 1 - y : y;
      if (transposed) std::swap(column, row);
      shown.pixel.push_back(stored.row(row)[column]);
    }
  return shown;
}

Camera turned(const Camera& stored, int orientation) {
  Camera camera = stored;
  auto& d = camera.distortion;
  const bool brown = camera.lens == LensModel::brown; // the fisheye model is rotationally symmetric
  if (isTransposed(orientation)) {
    std::swap(camera.width, camera.height);
    std::swap(camera.fx, camera.fy);
    std::swap(camera.cx, camera.cy);
    if (brown) {
      if (d[kTauX] != 0 && d[kTauY] != 0)
        throw Error("the model of a tilted sensor cannot be turned with the pictures: calibrate "
                    "the camera with pictures as they are shown");
      std::swap(d[kP1], d[kP2]);
      std::swap(d[kS1], d[kS3]);
      std::swap(d[kS2], d[kS4]);
      std::swap(d[kTauX] *= -1, d[kTauY] *= -1);
    }
  }
  if (isFlippedAcross(orientation)) {
    camera.cx = camera.width - 1 - camera.cx;
    if (brown)
      for (const int i : {kP2, kS1, kS2, kTauY}) d[index(i)] *= -1;
  }
  if (isFlippedDown(orientation)) {
    camera.cy = camera.height - 1 - camera.cy;
    if (brown)
      for (const int i : {kP1, kS3, kS4, kTauX}) d[index(i)] *= -1;
  }
  return camera;
}

void requireSize(const GreyFrame& image, const Camera& camera, const std::string& name) {
  if (image.width == camera.width && image.height == camera.height) return;
  const std::string by = image.orientation > 1 ? " (turned by its orientation " +
                                                     std::to_string(image.orientation) + ")"
                                               : "";
  throw FileError(name, 0,
                  "is " + sizeOf(image.width, image.height) + by +
                      ", but the camera was calibrated at " + sizeOf(camera.width, camera.height));
}

Camera cameraOf(const GreyFrame& image, const Camera& camera, const std::string& name) {
  const bool as_stored = isTransposed(image.orientation) && image.width != image.height &&
                         image.width == camera.height && image.height == camera.width;
  try {
    if (as_stored) return turned(camera, image.orientation);
  } catch (const Error& error) {
    throw FileError(name, 0, error.what());
  }
  requireSize(image, camera, name);
  return camera;
}

void TurnedFrames::add(const GreyFrame& image, const std::string& name) {
  if (frames_++ == 0) first_ = image.orientation;
  if (image.orientation != first_ && other_.empty())
    other_ = name + " has " + std::to_string(image.orientation);
  if (image.orientation == 1) return;
  if (turned_++ > 0) return;
  name_ = name;
  orientation_ = image.orientation;
}

std::string TurnedFrames::line(const Camera* camera, const std::string& unlike) const {
  if (turned_ == 0) return "";
  std::string line =
      name_ + ": is turned as viewers show it, by its orientation " + std::to_string(orientation_);
  if (turned_ > 1) line += "; so are " + formatCount(turned_) + " of " + formatCount(frames_);
  if (camera)
    line += "; the camera, calibrated at " + sizeOf(camera->width, camera->height) +
            " unturned, is turned along";
  if (!other_.empty())
    line += "; not all have one orientation (the first has " + std::to_string(first_) + ", " +
            other_ + "): " + unlike;
  return line;
}

} // namespace patina
