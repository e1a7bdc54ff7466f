#include "acquisition/calibration/board.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "acquisition/loaded/vision_library.h"
#include "core/decompose.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr int kQuickSide = 960;        // longest side of the picture in a quick search [px]
constexpr std::size_t kMinCorners = 6; // corners of a usable view

std::vector<std::string> partsOf(const std::string& text, char between) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == between)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

// Returns the normalised least-squares homography (Hartley 1997) of four or more points.
Eigen::Matrix3d homography(const std::vector<Vec2>& board, const std::vector<Vec2>& pixel) {
  const auto near = [](const std::vector<Vec2>& points) {
    Vec2 middle = Vec2::Zero();
    for (const Vec2& p : points) middle += p / static_cast<double>(points.size());
    double size = 0;
    for (const Vec2& p : points) size += (p - middle).norm() / static_cast<double>(points.size());
    Eigen::Matrix3d m;
    m << 1 / size, 0, -middle.x() / size, 0, 1 / size, -middle.y() / size, 0, 0, 1;
    return m;
  };
  const Eigen::Matrix3d from = near(board), to = near(pixel);
  // The last element is 1, because the centroid of the points is not at infinity.
  Eigen::Matrix<double, 8, 8> squares = Eigen::Matrix<double, 8, 8>::Zero();
  Eigen::Matrix<double, 8, 1> right = Eigen::Matrix<double, 8, 1>::Zero();
  for (std::size_t i = 0; i < board.size(); ++i) {
    const Vec3 b = from * board[i].homogeneous();
    const Vec2 p = (to * pixel[i].homogeneous()).head<2>();
    for (int k = 0; k < 2; ++k) {
      Eigen::Matrix<double, 8, 1> row = Eigen::Matrix<double, 8, 1>::Zero();
      row.segment<3>(3 * k) = b;
      row.tail<2>() = -p[k] * b.head<2>();
      squares += row * row.transpose();
      right += p[k] * row;
    }
  }
  const Eigen::Matrix<double, 8, 1> h = SymmetricSolver(squares).solve(right);
  Eigen::Matrix3d m;
  m << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1;
  return to.inverse() * m * from;
}

// Returns the picture with each square of `cells` pixels a side replaced by its mean.
GreyFrame shrunk(const GreyFrame& image, int cells) {
  GreyFrame small{image.width / cells, image.height / cells, {}};
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      int sum = 0;
      for (int k = 0; k < cells * cells; ++k)
        sum += image.row(cells * y + k / cells)[cells * x + k % cells];
      small.pixel.push_back(static_cast<std::uint8_t>(sum / (cells * cells)));
    }
  return small;
}

std::optional<BoardView> chessboardIn(const GreyFrame& image, const Board& board, bool quick) {
  // Corners are found to a pixel of the searched picture and then refined in the full one.
  const int cells = quick ? 1 + std::max(image.width, image.height) / kQuickSide : 1;
  const GreyFrame smaller = cells > 1 ? shrunk(image, cells) : GreyFrame();
  std::vector<Vec2> found;
  const std::string cause =
      visionLibrary().chessboard(cells > 1 ? smaller : image, board.columns, board.rows, found);
  if (!cause.empty()) throw Error(cause);
  if (found.empty()) return std::nullopt;
  for (Vec2& corner : found) corner = cells * (corner + Vec2(0.5, 0.5)) - Vec2(0.5, 0.5);
  BoardView view;
  for (int y = 0; y < board.rows; ++y)
    for (int x = 0; x < board.columns; ++x) {
      const Vec2& at = found[index(y * board.columns + x)];
      double cell = INFINITY;
      for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}})
        if (x + dx >= 0 && x + dx < board.columns && y + dy >= 0 && y + dy < board.rows)
          cell = std::min(cell, (found[index((y + dy) * board.columns + x + dx)] - at).norm());
      const auto saddle = refineSaddle(image, at, cell);
      if (!saddle) continue;
      view.board.emplace_back(board.square * x, board.square * y);
      view.pixel.push_back(*saddle);
    }
  return view;
}

// Returns the board's marker corners, top left first, for a white or a black top left square.
std::vector<Quad> markersOn(const Board& board, bool white_first) {
  std::vector<Quad> places;
  for (int y = 0; y < board.rows; ++y)
    for (int x = 0; x < board.columns; ++x) {
      if (((x + y) % 2 == 0) != white_first) continue;
      const Vec2 middle(board.square * (x + 0.5), board.square * (y + 0.5));
      const double h = board.marker / 2;
      places.push_back(
          {middle + Vec2(-h, -h), middle + Vec2(h, -h), middle + Vec2(h, h), middle + Vec2(-h, h)});
    }
  return places;
}

BoardView markersSeen(const std::vector<SeenMarker>& seen, const std::vector<Quad>& places) {
  BoardView view;
  for (const SeenMarker& marker : seen)
    for (std::size_t i = 0; i < 4; ++i) {
      view.board.push_back(places[index(marker.id)][i]);
      view.pixel.push_back(marker.corner[i].pixel);
    }
  return view;
}

// Returns the mean squared reprojection error of the view's homography [px^2].
double reprojectionError(const BoardView& view) {
  const Eigen::Matrix3d map = homography(view.board, view.pixel);
  double squares = 0;
  for (std::size_t i = 0; i < view.board.size(); ++i)
    squares += ((map * view.board[i].homogeneous()).hnormalized() - view.pixel[i]).squaredNorm();
  return squares;
}

std::optional<BoardView> charucoIn(const GreyFrame& image, const Board& board) {
  const MarkerFamily& family = markerFamily(board.family);
  std::vector<int> ids(index(board.columns * board.rows / 2));
  if (ids.size() > family.code.size())
    throw Error("family " + board.family + " has no more than " +
                std::to_string(family.code.size()) + " markers");
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<int>(i);
  const auto seen = findMarkers(image, {CodeBook(family, ids)}, nullptr);
  BoardView markers = markersSeen(seen, markersOn(board, false)), view;
  // The other layout shifts every other row by a square, which no homography does. The markers of a
  // single row fit both layouts, which then differ by a shift of the board by one square.
  if (board.rows % 2 == 0 && seen.size() > 1)
    if (BoardView other = markersSeen(seen, markersOn(board, true));
        reprojectionError(other) < reprojectionError(markers))
      markers = std::move(other);
  for (int y = 1; y < board.rows; ++y)
    for (int x = 1; x < board.columns; ++x) {
      // Only the nearest corners are used, because of the lens's distortion.
      const Vec2 corner(board.square * x, board.square * y);
      std::vector<Vec2> near, pixel;
      for (std::size_t i = 0; i < markers.board.size(); ++i)
        if ((markers.board[i] - corner).norm() < 1.8 * board.square) {
          near.push_back(markers.board[i]);
          pixel.push_back(markers.pixel[i]);
        }
      if (near.size() < 8) continue;
      const Eigen::Matrix3d map = homography(near, pixel);
      const auto at = [&](const Vec2& p) -> Vec2 { return (map * p.homogeneous()).hnormalized(); };
      const Vec2 guess = at(corner);
      double cell = INFINITY;
      for (const Vec2& step : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1)})
        cell = std::min(cell, (at(corner + board.square * step) - guess).norm());
      // The neighbouring markers must lie outside the refinement window.
      const auto saddle = refineSaddle(image, guess, cell * (1 - board.marker / board.square));
      if (!saddle) continue;
      view.board.push_back(corner);
      view.pixel.push_back(*saddle);
    }
  return view;
}

} // namespace

std::array<Vec2, 4> outlineOf(const BoardView& view, const Board& board) {
  const Eigen::Matrix3d map = homographyOf(view);
  const double wide = board.square * board.columns, high = board.square * board.rows;
  std::array<Vec2, 4> outline{Vec2(0, 0), Vec2(wide, 0), Vec2(wide, high), Vec2(0, high)};
  for (Vec2& corner : outline) corner = (map * corner.homogeneous()).hnormalized();
  return outline;
}

Eigen::Matrix3d homographyOf(const BoardView& view) {
  return homography(view.board, view.pixel);
}

double blurOf(const GreyFrame& image, const BoardView& view, const Board& board) {
  const auto cellOf = [&](std::size_t i) -> std::pair<long, long> {
    const Vec2 cell = view.board[i] / board.square;
    return {std::lround(cell.x()), std::lround(cell.y())};
  };
  std::map<std::pair<long, long>, std::size_t> corners;
  for (std::size_t i = 0; i < view.board.size(); ++i) corners[cellOf(i)] = i;
  // An edge of black and white runs between neighbouring corners.
  std::array<std::vector<double>, 2> slopes; // the steepest of each edge, by the edges' direction
  std::vector<double> greys;
  for (const auto& [cell, i] : corners)
    for (std::size_t along = 0; along < 2; ++along) {
      const auto next = corners.find({cell.first + (along == 0), cell.second + (along == 1)});
      if (next == corners.end()) continue;
      const Vec2 edge = view.pixel[next->second] - view.pixel[i];
      const Vec2 across = Vec2(-edge.y(), edge.x()).normalized();
      const int reach = static_cast<int>(2 * std::clamp(0.3 * edge.norm(), 2., 10.)); // half pixels
      std::vector<double> profile;
      for (int k = -reach; k <= reach; ++k) {
        double sum = 0;
        for (const double share : {0.3, 0.4, 0.5, 0.6, 0.7}) {
          const Vec2 p = view.pixel[i] + share * edge + 0.5 * k * across;
          sum += greyAt(image, p.x(), p.y()).value_or(NAN) / 5;
        }
        profile.push_back(sum);
      }
      double steepest = 0;
      for (std::size_t k = 0; k + 2 < profile.size(); ++k)
        steepest = std::max(steepest, std::abs(profile[k + 2] - profile[k]));
      if (std::isnan(profile.front()) || std::isnan(profile.back())) continue;
      slopes[along].push_back(steepest);
      greys.insert(greys.end(), profile.begin(), profile.end());
    }
  const auto quantile = [](std::vector<double>& values, double share) {
    const auto place = values.begin() +
                       static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  double steepest = INFINITY;
  for (std::vector<double>& each : slopes)
    if (!each.empty()) steepest = std::min(steepest, quantile(each, 0.5));
  if (greys.empty()) return INFINITY;
  // The slope of a Gaussian edge is its contrast over sqrt(2 pi) deviations.
  return (quantile(greys, 0.95) - quantile(greys, 0.05)) /
         (std::sqrt(2 * std::numbers::pi) * std::max(steepest, 1e-3));
}

std::optional<Vec2> refineSaddle(const GreyFrame& image, const Vec2& corner, double cell) {
  const double reach = std::clamp(0.45 * cell, 2., 8.);
  Vec2 at = corner;
  for (int round = 0; round < 30; ++round) {
    // Grey gradients on the edges are orthogonal to the saddle's direction (Foerstner & Guelch
    // 1987).
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
    Vec2 sum = Vec2::Zero();
    const int steps = static_cast<int>(std::ceil(reach));
    for (int j = -steps; j <= steps; ++j)
      for (int i = -steps; i <= steps; ++i) {
        const Vec2 aside(i, j), p = at + aside;
        const auto left = greyAt(image, p.x() - 1, p.y()), right = greyAt(image, p.x() + 1, p.y()),
                   up = greyAt(image, p.x(), p.y() - 1), down = greyAt(image, p.x(), p.y() + 1);
        if (!left || !right || !up || !down) return std::nullopt;
        const Vec2 slope(*right - *left, *down - *up);
        const double weight = std::exp(-2 * aside.squaredNorm() / (reach * reach));
        squares += weight * slope * slope.transpose();
        sum += weight * slope * slope.dot(aside);
      }
    const double trace = squares.trace();
    if (!(squares.determinant() > 1e-3 * trace * trace)) return std::nullopt;
    const Vec2 step = squares.inverse() * sum;
    at += step;
    if ((at - corner).norm() > std::max(1.5, cell / 3)) return std::nullopt;
    if (step.squaredNorm() < 1e-8) return at;
  }
  return at;
}

Board parseBoard(const std::string& text) {
  const std::vector<std::string> parts = partsOf(text, ':');
  const bool chess = parts[0] == "chessboard" && parts.size() == 3;
  const bool charuco = parts[0] == "charuco" && parts.size() == 5;
  const auto count = [](const std::string& word) {
    const auto value = parseNumber(word);
    return value && *value >= 2 && *value <= 100 && *value == std::floor(*value)
               ? static_cast<int>(*value)
               : 0;
  };
  Board board;
  if (chess || charuco) {
    const std::vector<std::string> sides = partsOf(parts[1], 'x');
    board.columns = count(sides[0]);
    board.rows = sides.size() == 2 ? count(sides[1]) : 0;
    board.square = parseLength(parts[2]);
  }
  if (charuco) {
    board.marker = parseLength(parts[3]);
    board.family = parts[4];
  }
  if (!board.columns || !board.rows || !(board.square > 0 && board.square < 10) ||
      (charuco && !(board.marker > 0 && board.marker < board.square)))
    throw Error("'" + text +
                "' is no board: chessboard:COLUMNSxROWS:SQUARE, counted in inner corners, or "
                "charuco:COLUMNSxROWS:SQUARE:MARKER:FAMILY, counted in squares");
  return board;
}

std::optional<BoardView> findBoard(const GreyFrame& image, const Board& board, bool quick) {
  auto view = board.family.empty() ? chessboardIn(image, board, quick) : charucoIn(image, board);
  if (view && view->pixel.size() < kMinCorners) view.reset();
  return view;
}

} // namespace patina
