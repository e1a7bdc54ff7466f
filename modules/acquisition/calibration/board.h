// Calibration boards and the detection of their corners in a picture (A05).
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "acquisition/loaded/vision.h"
#include "acquisition/tracking/marker_finder.h"

namespace patina {

// Board with squares of side `square` [m]. A chessboard counts its inner corners. A ChArUco board
// counts its squares; its white ones hold markers of side `marker` [m], numbered by rows from 0.
// Its top left square is black; OpenCV before 4.6 made it white for an even number of rows, which
// the picture decides.
struct Board {
  int columns = 0, rows = 0;
  double square = 0, marker = 0;
  std::string family; // family of a ChArUco board; empty: a chessboard
};

// Parses "chessboard:9x6:25mm" or "charuco:5x7:40mm:20mm:6x6_250"; else throws Error.
Board parseBoard(const std::string& text);

// Returns the inner corners, or nullopt if fewer than six are found; a chessboard must be complete.
// `quick` searches a chessboard in a smaller picture, because a large one without any takes
// seconds. Throws Error if the family has too few markers for the board.
std::optional<BoardView> findBoard(const GreyFrame& image, const Board& board, bool quick = false);

// Returns the board's four outer corners in the picture [px], by the view's homography.
std::array<Vec2, 4> outlineOf(const BoardView& view, const Board& board);

// Returns pixel_from_board, the least-squares homography of the view, without the lens's
// distortion.
Eigen::Matrix3d homographyOf(const BoardView& view);

// Returns the standard deviation of the blur across the board's edges, of the blurrier of its two
// directions, with the pixels' own share: .5 or more [px]. Motion and defocus raise it, brightness
// does not. Returns infinity if no edge lies within the picture.
double blurOf(const GreyFrame& image, const BoardView& view, const Board& board);

// Returns the saddle point of grey near a corner where four squares meet; `cell` [px] is their
// shortest side. Returns nullopt if there is none within a third of it.
std::optional<Vec2> refineSaddle(const GreyFrame& image, const Vec2& corner, double cell);

} // namespace patina
