// Guides a person who photographs a calibration board: which parts of the picture and which tilts
// have been seen, whether the newest view is sharp, and what to do next (A05). A camera is known
// well from views that fill the picture and are tilted to all sides (Zhang 2000).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/calibration/board.h"

namespace patina {

// A sharp view that differs from the others.
struct GoodView {
  std::array<Vec2, 4> outline; // board's outer corners [px]
  Eigen::Matrix3d pixel_from_board;
};

struct BoardGuide {
  static constexpr std::size_t kCells = 4;     // cells along each side of the picture
  static constexpr std::size_t kMinViews = 20; // size of a complete set
  static constexpr std::size_t kMaxViews = 60; // size that ends an incomplete set
  static constexpr double kMinTilt = 0.26;     // sine of the smallest tilt that counts
  static constexpr std::array<const char*, 4> kSides = {"left", "right", "upper", "lower"};

  std::array<bool, kCells * kCells> seen{}; // cells with corners of a good view, by rows
  std::array<bool, 4> tilted{};             // this side of the board has been nearer to the camera
  std::vector<GoodView> views;
  std::optional<double> blur; // blurOf() the newest picture, if it shows the board [px]
  bool complete = false;      // all cells and tilts have been seen
  std::string advice = "hold the board into the picture"; // the next thing to do

  std::size_t seenCells() const;
  std::size_t seenTilts() const;
  // "12 views, 9 of 16 parts of the picture, 2 of 4 tilts".
  std::string summary() const;
};

// Judges the next picture, in which findBoard() found `view`, and renews the advice. Returns true
// if the view is sharp, near and new, and was added. Sides and corners are those of the picture.
// Tilts follow from the views and from the focal length that they have in common, which assumes
// square pixels and a center in the middle; before views are tilted it is three quarters of the
// picture's diagonal.
bool addPicture(BoardGuide& guide, const GreyFrame& image, const std::optional<BoardView>& view,
                const Board& board);

// Returns the distance of two outlines, rms of their corners [px].
double distanceOf(const std::array<Vec2, 4>& a, const std::array<Vec2, 4>& b);

} // namespace patina
