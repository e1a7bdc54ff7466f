// Statistics of a rendered picture, because golden files of OpenGL differ from one machine to the
// next.
#pragma once

#include <filesystem>
#include <string>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkSmartPointer.h>

#include "core/types.h"
#include "support/own_display.h"

namespace patina {

class Pixels {
 public:
  explicit Pixels(const std::filesystem::path& png) {
    const vtkNew<vtkPNGReader> reader;
    reader->SetFileName(png.c_str());
    reader->Update();
    image_ = reader->GetOutput();
  }
  int width() const { return image_->GetDimensions()[0]; }
  int height() const { return image_->GetDimensions()[1]; }
  Vec3 at(int x, int y) const { // y from below; 0 .. 255
    const auto* rgb = static_cast<const unsigned char*>(image_->GetScalarPointer(x, y, 0));
    return {double(rgb[0]), double(rgb[1]), double(rgb[2])};
  }
  // Returns the share 0 .. 1 of the pixels in a part of the picture (fractions) that satisfy the
  // test. x0 skips the corner with the axes, whose colours are those of other things.
  template <typename Test>
  double share(Test test, double x0 = 0.14, double x1 = 1, double y0 = 0, double y1 = 1) const {
    int hits = 0, all = 0;
    for (int y = int(y0 * height()); y < int(y1 * height()); ++y)
      for (int x = int(x0 * width()); x < int(x1 * width()); ++x, ++all)
        if (test(at(x, y))) ++hits;
    return all == 0 ? 0 : double(hits) / all;
  }

 private:
  vtkSmartPointer<vtkImageData> image_;
};

// The surface's sage: green above red and blue. The background never is.
inline bool isSurface(const Vec3& c) {
  return c[1] > c[0] + 3 && c[1] > c[2] + 5;
}
inline bool isTool(const Vec3& c) {
  return c[0] > 150 && c[0] > c[1] + 40 && c[1] > c[2] + 30;
}
inline bool isForce(const Vec3& c) {
  return c[0] > 120 && c[1] < 70 && c[2] < 100;
}
inline bool isGold(const Vec3& c) { // the offset's band, over anything
  return c[0] > c[2] + 60 && c[1] > c[2] + 45;
}
inline bool isMagenta(const Vec3& c) { // the magnet's
  return c[0] > c[1] + 25 && c[2] > c[1] + 12;
}
inline bool isWarm(const Vec3& c) {
  return c[0] > c[2] + 40 && c[0] > c[1] + 25;
}
inline bool isCool(const Vec3& c) {
  return c[2] > c[0] + 40;
}

#define PATINA_NEEDS_DISPLAY()                                                                     \
  if (!test::hasDisplay()) GTEST_SKIP() << "neither Xvfb nor DISPLAY"

} // namespace patina
