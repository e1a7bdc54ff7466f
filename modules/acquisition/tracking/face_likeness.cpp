#include "acquisition/tracking/face_likeness.h"

#include <algorithm>
#include <cmath>

#include "acquisition/tracking/edge_fit.h"
#include "acquisition/tracking/lens.h"
#include "acquisition/tracking/marker_code.h"

namespace patina {
namespace {

constexpr double kLeastWide = 2;  // of a marker that is looked at [px]
constexpr double kBlurred = 4;    // pixels that share one grey
constexpr double kSharpest = 0.9; // correlation; beyond it light and print decide

double areaOf(const Quad& q) {
  return 0.5 * (cross(q[1] - q[0], q[2] - q[0]) + cross(q[2] - q[0], q[3] - q[0]));
}

// Bright or dark as it is printed, with a ring of white around the black border.
bool isWhite(const MarkerFamily& family, std::uint64_t code, int x, int y) {
  const int all = family.side + 4, ring = std::min({x, y, all - 1 - x, all - 1 - y});
  if (ring < 2) return ring == 0;
  const int bit = (y - 2) * family.side + x - 2;
  return code >> (family.side * family.side - 1 - bit) & 1;
}

double likenessOf(const GreyFrame& image, const RigMarker& marker, const Camera& camera,
                  const Pose& pose) {
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 p = pose * marker.corners()[i];
    if (!(p.z() > 1e-6)) return 0;
    quad[i] = pixelOf(camera, p);
  }
  // Clockwise as one sees it, unless its back is seen.
  const double area = areaOf(quad);
  const double longest = std::max((quad[2] - quad[0]).norm(), (quad[3] - quad[1]).norm());
  if (!(area > kLeastWide * longest)) return 0;
  const MarkerFamily& family = markerFamily(marker.family);
  const int all = family.side + 4;
  const double cell = marker.size / (family.side + 2);
  double n = 0, print = 0, grey = 0, both = 0, prints = 0, greys = 0;
  for (int y = 0; y < all; ++y)
    for (int x = 0; x < all; ++x) {
      const Vec3 place(-marker.size / 2 + (x - 0.5) * cell, marker.size / 2 - (y - 0.5) * cell, 0);
      const Vec3 p = pose * (marker.probe_from_marker * place);
      if (!(p.z() > 1e-6)) return 0;
      const Vec2 pixel = pixelOf(camera, p);
      const auto g = greyAt(image, pixel.x(), pixel.y());
      if (!g) return 0; // it hangs out of the picture
      const double w =
          isWhite(family, family.code[static_cast<std::size_t>(marker.id)], x, y) ? 1 : 0;
      n += 1, print += w, grey += *g, both += w * *g, prints += w * w, greys += *g * *g;
    }
  const double spread = (prints - print * print / n) * (greys - grey * grey / n);
  if (!(spread > 0)) return 0;
  const double correlation =
      std::clamp((both - print * grey / n) / std::sqrt(spread), 0., kSharpest);
  // Of a regression with so many numbers that are not blurred into each other.
  return -0.5 * std::min(n, area / kBlurred) * std::log(1 - correlation * correlation);
}

} // namespace

double faceLikeness(const GreyFrame& image, const std::vector<RigMarker>& rig, const Camera& camera,
                    const Pose& camera_from_probe) {
  double sum = 0;
  for (const RigMarker& marker : rig) sum += likenessOf(image, marker, camera, camera_from_probe);
  return sum;
}

} // namespace patina
