#include "acquisition/tracking/marker_finder.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

Vec2 middleOf(const SeenMarker& marker) {
  Vec2 sum = Vec2::Zero();
  for (const FittedCorner& corner : marker.corner) sum += corner.pixel / 4;
  return sum;
}

// Keeps the better of two detections of one marker.
void keep(std::vector<SeenMarker>& seen, const SeenMarker& marker) {
  for (SeenMarker& other : seen) {
    const double size = (other.corner[0].pixel - other.corner[2].pixel).norm();
    if ((middleOf(other) - middleOf(marker)).norm() > 0.25 * size) continue;
    if (std::pair(marker.hamming_distance, marker.roughness) <
        std::pair(other.hamming_distance, other.roughness))
      other = marker;
    return;
  }
  seen.push_back(marker);
}

void look(const GreyFrame& image, const std::vector<CodeBook>& books, const Camera* lens,
          const QuadOptions& search, std::vector<SeenMarker>& seen) {
  for (const Quad& quad : findQuads(image, search)) {
    constexpr int kBits = 8; // width in most families
    auto fitted = fitEdges(image, quad, lens, kBits);
    if (!fitted) continue;
    for (const CodeBook& book : books) {
      const auto match = readCode(image, fitted->pixels(), book);
      if (!match) continue;
      if (const int bits = book.family().side + 2; bits != kBits)
        if (const auto closer = fitEdges(image, fitted->pixels(), lens, bits)) fitted = closer;
      SeenMarker marker{book.family().name, match->id, match->hamming_distance, fitted->corner,
                        fitted->roughness};
      std::rotate(marker.corner.begin(), marker.corner.begin() + match->quarter_turns,
                  marker.corner.end());
      keep(seen, marker);
      break;
    }
  }
}

GreyFrame doubled(const GreyFrame& image) {
  GreyFrame out{2 * image.width, 2 * image.height, {}};
  out.pixel.reserve(4 * image.pixel.size());
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const double u = std::clamp(x / 2. - 0.25, 0., image.width - 1.001),
                   v = std::clamp(y / 2. - 0.25, 0., image.height - 1.001);
      out.pixel.push_back(static_cast<std::uint8_t>(std::lround(greyAt(image, u, v).value_or(0))));
    }
  return out;
}

Vec2 halved(const Vec2& p) {
  return {p.x() / 2 - 0.25, p.y() / 2 - 0.25};
}

void lookTwiceAsLarge(const GreyFrame& image, const std::vector<CodeBook>& books,
                      const Camera* lens, const QuadOptions& search,
                      std::vector<SeenMarker>& seen) {
  Camera large;
  if (lens) {
    large = *lens;
    large.fx *= 2, large.fy *= 2;
    large.cx = 2 * large.cx + 0.5, large.cy = 2 * large.cy + 0.5;
  }
  std::vector<SeenMarker> more;
  look(doubled(image), books, lens ? &large : nullptr, search, more);
  for (SeenMarker& marker : more) {
    for (FittedCorner& corner : marker.corner) {
      corner.pixel = halved(corner.pixel);
      corner.undistorted = halved(corner.undistorted);
      corner.whiten *= 2;
    }
    marker.roughness /= 2;
    keep(seen, marker);
  }
}

} // namespace

std::vector<SeenMarker> findMarkers(const GreyFrame& image, const std::vector<CodeBook>& books,
                                    const Camera* lens, const FinderOptions& options) {
  std::vector<SeenMarker> seen;
  look(image, books, lens, {}, seen);
  if (!options.thorough) return seen;
  for (const double split : {0.5, 0.35, 0.65}) {
    QuadOptions search{split, 8};
    look(image, books, lens, search, seen);
    search.shortest *= 1.5;
    lookTwiceAsLarge(image, books, lens, search, seen);
  }
  return seen;
}

} // namespace patina
