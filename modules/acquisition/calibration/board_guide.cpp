#include "acquisition/calibration/board_guide.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <Eigen/Geometry>

namespace patina {
namespace {

constexpr double kNewOutline = 0.03;              // smallest distance of a new view [diagonals]
constexpr double kMinArea = 0.06;                 // smallest board [picture's area]
constexpr double kMaxBlur = 1.5;                  // largest blur in a small picture [px]
constexpr double kBlurPerSize = 1.2e-3;           // largest blur in a large one [diagonals]
constexpr double kUsualFocal = 0.75;              // assumed focal length [diagonals]
constexpr double kMinFocal = 0.35, kMaxFocal = 4; // [diagonals]
constexpr double kTiltedViews = 0.02;             // least information about the focal length

struct PictureSize {
  int width, height;
  double diagonal() const { return std::hypot(width, height); }
};

// Returns the homography in diagonals from the picture's middle, its axes of length about 1.
Eigen::Matrix3d centered(const Eigen::Matrix3d& pixel_from_board, const PictureSize& size) {
  const double d = size.diagonal();
  Eigen::Matrix3d from_pixel;
  from_pixel << 1 / d, 0, -0.5 * (size.width - 1) / d, 0, 1 / d, -0.5 * (size.height - 1) / d, 0, 0,
      1;
  const Eigen::Matrix3d map = from_pixel * pixel_from_board;
  return map / map.topLeftCorner<2, 2>().norm();
}

// The board's axes are orthogonal and equally long (Zhang 2000), which is linear in the inverse
// square of the focal length.
double focalOf(const std::vector<GoodView>& views, const PictureSize& size) {
  double squares = 0, products = 0;
  for (const GoodView& view : views) {
    const Eigen::Matrix3d m = centered(view.pixel_from_board, size);
    const Vec2 a = m.col(0).head<2>(), b = m.col(1).head<2>();
    const Vec2 plane(a.dot(b), a.squaredNorm() - b.squaredNorm());
    const Vec2 depth(m(2, 0) * m(2, 1), m(2, 0) * m(2, 0) - m(2, 1) * m(2, 1));
    squares += plane.squaredNorm();
    products -= plane.dot(depth);
  }
  if (squares < kTiltedViews || !(products > 0)) return kUsualFocal;
  return std::clamp(std::sqrt(squares / products), kMinFocal, kMaxFocal);
}

// Returns the sines of the board's tilt: how much nearer its left and upper sides are.
Vec2 boardTilt(const Eigen::Matrix3d& pixel_from_board, double focal, const PictureSize& size) {
  Eigen::Matrix3d m = centered(pixel_from_board, size);
  m.topRows<2>() /= focal;
  const Vec3 normal = m.col(0).cross(m.col(1)).normalized();
  return (normal.z() > 0 ? -1 : 1) * normal.head<2>();
}

std::string cellName(std::size_t cell) {
  const std::size_t row = cell / BoardGuide::kCells, column = cell % BoardGuide::kCells,
                    last = BoardGuide::kCells - 1;
  const std::string across = column == 0 ? "left" : column == last ? "right" : "";
  const std::string down = row == 0 ? "upper" : row == last ? "lower" : "";
  if (!across.empty() && !down.empty()) return "the " + down + " " + across + " corner";
  if (across.empty() && down.empty()) return "the middle";
  return "the " + across + down + " edge";
}

// Corners come first, because views there cover the edges too.
std::optional<std::size_t> missingCell(const BoardGuide& guide) {
  const std::size_t last = BoardGuide::kCells - 1;
  for (const std::size_t corner : {std::size_t{0}, last, last * BoardGuide::kCells,
                                   BoardGuide::kCells * BoardGuide::kCells - 1})
    if (!guide.seen[corner]) return corner;
  const auto open = std::ranges::find(guide.seen, false);
  if (open == guide.seen.end()) return std::nullopt;
  return static_cast<std::size_t>(open - guide.seen.begin());
}

std::string adviceFor(const BoardGuide& guide) {
  if (guide.complete) return "done";
  if (const auto cell = missingCell(guide)) return "nearer to " + cellName(*cell);
  for (std::size_t i = 0; i < guide.tilted.size(); ++i)
    if (!guide.tilted[i])
      return std::string("tilt its ") + BoardGuide::kSides[i] + " side to the camera";
  return "move it on: " + std::to_string(BoardGuide::kMinViews - guide.views.size()) +
         " more views";
}

} // namespace

std::size_t BoardGuide::seenCells() const {
  return static_cast<std::size_t>(std::ranges::count(seen, true));
}

std::size_t BoardGuide::seenTilts() const {
  return static_cast<std::size_t>(std::ranges::count(tilted, true));
}

std::string BoardGuide::summary() const {
  return std::to_string(views.size()) + (views.size() == 1 ? " view, " : " views, ") +
         std::to_string(seenCells()) + " of " + std::to_string(seen.size()) +
         " parts of the picture, " + std::to_string(seenTilts()) + " of 4 tilts";
}

double distanceOf(const std::array<Vec2, 4>& a, const std::array<Vec2, 4>& b) {
  double squares = 0;
  for (std::size_t i = 0; i < 4; ++i) squares += (a[i] - b[i]).squaredNorm() / 4;
  return std::sqrt(squares);
}

bool addPicture(BoardGuide& guide, const GreyFrame& image, const std::optional<BoardView>& view,
                const Board& board) {
  guide.blur.reset();
  if (guide.complete) return false;
  if (!view) {
    guide.advice = "not found: hold it into the light";
    return false;
  }
  const PictureSize size{image.width, image.height};
  const GoodView found{outlineOf(*view, board), homographyOf(*view)};
  guide.blur = blurOf(image, *view, board);
  if (*guide.blur > std::max(kMaxBlur, kBlurPerSize * size.diagonal())) {
    char words[80];
    std::snprintf(words, sizeof words, "hold still or focus: blurred %.1f px", *guide.blur);
    guide.advice = words;
    return false;
  }
  double area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 &a = found.outline[i], &b = found.outline[(i + 1) % 4];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  if (!(std::abs(area) > kMinArea * size.width * size.height)) {
    guide.advice = "closer: the board is small";
    return false;
  }
  auto seen = guide.seen;
  for (const Vec2& corner : view->pixel) {
    const auto cell = [](double place, int length) {
      const double share = std::clamp((place + 0.5) / length, 0., 1 - 1e-9);
      return static_cast<std::size_t>(BoardGuide::kCells * share);
    };
    seen[BoardGuide::kCells * cell(corner.y(), image.height) + cell(corner.x(), image.width)] =
        true;
  }
  const bool is_new =
      seen != guide.seen || std::ranges::all_of(guide.views, [&](const GoodView& before) {
        return distanceOf(before.outline, found.outline) > kNewOutline * size.diagonal();
      });
  if (is_new) {
    guide.seen = seen;
    guide.views.push_back(found);
    const double focal = focalOf(guide.views, size);
    guide.tilted = {};
    for (const GoodView& each : guide.views) {
      const Vec2 tilt = boardTilt(each.pixel_from_board, focal, size);
      for (std::size_t i = 0; i < 4; ++i)
        guide.tilted[i] |= (i % 2 == 0 ? 1 : -1) * tilt[i / 2] >= BoardGuide::kMinTilt;
    }
    guide.complete = guide.views.size() >= BoardGuide::kMaxViews ||
                     (guide.views.size() >= BoardGuide::kMinViews && !missingCell(guide) &&
                      guide.seenTilts() == guide.tilted.size());
  }
  guide.advice = adviceFor(guide);
  return is_new;
}

} // namespace patina
