// Boards that a camera is calibrated with, and their corners in a picture (A05).
#pragma once

#include <array>
#include <optional>

#include "acquisition/tracking/marker_finder.h"
#include "acquisition/vision/vision.h"

namespace patina {

// Squares of `square` [m]. A chessboard counts its inner corners. A ChArUco board counts its
// squares, with markers of `marker` [m] in the white ones, from 0 on by rows. Its top left square
// is black; until 4.6 OpenCV made it white where the number of rows is even, which a picture tells.
struct Board {
  int columns = 0, rows = 0;
  double square = 0, marker = 0;
  std::string family; // of a ChArUco board; empty: a chessboard
};

// "chessboard:9x6:25mm", "charuco:5x7:40mm:20mm:6x6_250". Throws Error saying what is expected.
Board parseBoard(const std::string& text);

// Inner corners; nothing where fewer than six are seen. Of a chessboard all or nothing; `quick`
// looks for it in a smaller picture, as a large one without any takes seconds. Throws Error where
// the family has too few markers for the board.
std::optional<BoardView> findBoard(const GreyFrame& image, const Board& board, bool quick = false);

// Returns where the board's four outer corners lie in the picture [px], by the view's homography.
std::array<Vec2, 4> outlineOf(const BoardView& view, const Board& board);

// Returns how sharp the picture is at the view's corners: the squared slope across the blurrier
// direction, as a part of the contrast. Motion and bad focus lower it, light does not.
double sharpnessOf(const GreyFrame& image, const BoardView& view);

// The saddle of grey near a corner where four squares meet, `cell` [px] being the least of their
// sides; nothing if there is none within a third of it.
std::optional<Vec2> saddleNear(const GreyFrame& image, const Vec2& corner, double cell);

} // namespace patina
