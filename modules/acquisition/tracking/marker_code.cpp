#include "acquisition/tracking/marker_code.h"

#include <bit>
#include <map>
#include <mutex>
#include <numeric>

#include "acquisition/loaded/vision_library.h"
#include "acquisition/tracking/edge_fit.h"
#include "core/decompose.h"
#include "core/error.h"

namespace patina {
namespace {

// Rotates a code by a quarter turn: its top becomes the right side.
std::uint64_t turned(std::uint64_t code, int side) {
  std::uint64_t out = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const int from = (side - 1 - x) * side + y;
      out = out << 1 | (code >> (side * side - 1 - from) & 1);
    }
  return out;
}

std::array<std::uint64_t, 4> rotationsOf(std::uint64_t code, int side) {
  std::array<std::uint64_t, 4> turns{code};
  for (std::size_t i = 1; i < 4; ++i) turns[i] = turned(turns[i - 1], side);
  return turns;
}

// Returns three fifths of the bits that the family's least Hamming distance could correct.
int correctable(const MarkerFamily& family) {
  int least = family.side * family.side;
  for (std::size_t i = 0; i < family.code.size(); ++i) {
    const auto turns = rotationsOf(family.code[i], family.side);
    for (std::size_t turn = 0; turn < 4; ++turn)
      for (std::size_t j = 0; j <= i; ++j)
        if (turn || j < i) least = std::min(least, std::popcount(turns[turn] ^ family.code[j]));
  }
  return (least - 1) / 2 * 3 / 5;
}

// Least-squares plane of grey over the marker.
struct Shade {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Vec3 sums = Vec3::Zero(), plane = Vec3::Zero();

  void add(double x, double y, double grey) {
    const Vec3 at(x, y, 1);
    squares += at * at.transpose();
    sums += grey * at;
  }
  bool solve() {
    if (squares(2, 2) < 4) return false;
    plane = SymmetricSolver(squares).solve(sums);
    return plane.allFinite();
  }
  double at(double x, double y) const { return plane.dot(Vec3(x, y, 1)); }
};

// Returns the grey of all cells, with the black border and one more ring; NaN outside the image.
Eigen::MatrixXd cellsOf(const GreyFrame& image, const Quad& quad, int side) {
  const int all = side + 4;
  const double cell = 1. / (side + 2);
  const Eigen::Matrix3d map = homographyTo(quad);
  Eigen::MatrixXd grey(all, all);
  for (int y = 0; y < all; ++y)
    for (int x = 0; x < all; ++x) {
      double sum = 0;
      for (const Vec2& aside :
           {Vec2(0, 0), Vec2(-.2, -.2), Vec2(.2, -.2), Vec2(-.2, .2), Vec2(.2, .2)}) {
        const Vec2 at = cell * (Vec2(x - 0.5, y - 0.5) + aside);
        const Vec2 p = (map * at.homogeneous()).hnormalized();
        sum += greyAt(image, p.x(), p.y()).value_or(std::nan(""));
      }
      grey(y, x) = sum / 5;
    }
  return grey;
}

// Removes the neighbours' blur from cells of a few pixels.
void sharpen(Eigen::MatrixXd& grey) {
  const Eigen::MatrixXd from = grey;
  for (Eigen::Index y = 1; y + 1 < grey.rows(); ++y)
    for (Eigen::Index x = 1; x + 1 < grey.cols(); ++x) {
      const double change = 0.25 * (4 * from(y, x) - from(y - 1, x) - from(y + 1, x) -
                                    from(y, x - 1) - from(y, x + 1));
      if (std::isfinite(change)) grey(y, x) += change;
    }
}

} // namespace

Eigen::Matrix3d homographyTo(const Quad& q) {
  const Vec2 a = q[1] - q[2], b = q[3] - q[2], c = q[0] - q[1] + q[2] - q[3];
  const double det = cross(a, b), g = cross(c, b) / det, h = cross(a, c) / det;
  Eigen::Matrix3d m;
  m.col(0) << q[1] - q[0] + g * q[1], g;
  m.col(1) << q[3] - q[0] + h * q[3], h;
  m.col(2) << q[0], 1;
  return m;
}

const MarkerFamily& markerFamily(const std::string& name) {
  static std::mutex one;
  static std::map<std::string, MarkerFamily> known;
  const std::lock_guard lock(one);
  const auto found = known.find(name);
  if (found != known.end()) return found->second;
  MarkerFamily family;
  if (const std::string cause = visionLibrary().family(name, family); !cause.empty())
    throw Error(cause);
  family.max_correction = correctable(family);
  return known.emplace(name, std::move(family)).first->second;
}

CodeBook::CodeBook(const MarkerFamily& family, const std::vector<int>& ids)
    : family_(&family), ids_(ids) {
  for (const int id : ids)
    turned_.push_back(rotationsOf(family.code.at(static_cast<std::size_t>(id)), family.side));
}

CodeBook::CodeBook(const MarkerFamily& family)
    : CodeBook(family, [&] {
        std::vector<int> ids(family.code.size());
        std::iota(ids.begin(), ids.end(), 0);
        return ids;
      }()) {}

std::optional<CodeBook::Match> CodeBook::match(std::uint64_t code) const {
  std::optional<Match> best;
  for (std::size_t i = 0; i < ids_.size(); ++i)
    for (int turn = 0; turn < 4; ++turn) {
      const int wrong = std::popcount(code ^ turned_[i][static_cast<std::size_t>(turn)]);
      if (wrong <= (best ? best->hamming_distance - 1 : family_->max_correction))
        best = Match{ids_[i], turn, wrong};
    }
  return best;
}

std::optional<CodeBook::Match> readCode(const GreyFrame& image, const Quad& quad,
                                        const CodeBook& book) {
  const int side = book.family().side, all = side + 4;
  Eigen::MatrixXd grey = cellsOf(image, quad, side);
  const double size = std::min((quad[1] - quad[0]).norm(), (quad[2] - quad[1]).norm());
  if (size < 5 * (side + 2)) sharpen(grey);
  const auto ring = [&](int x, int y) { return std::min({x, y, all - 1 - x, all - 1 - y}); };
  Shade white, black;
  for (int y = 0; y < all; ++y)
    for (int x = 0; x < all; ++x)
      if (const int depth = ring(x, y); depth < 2 && std::isfinite(grey(y, x)))
        (depth ? black : white).add(x, y, grey(y, x));
  if (!white.solve() || !black.solve()) return std::nullopt;
  std::uint64_t code = 0;
  int wrong = 0;
  for (int y = 1; y + 1 < all; ++y)
    for (int x = 1; x + 1 < all; ++x) {
      const double low = black.at(x, y), high = white.at(x, y);
      if (!(high - low > 5) || !std::isfinite(grey(y, x))) return std::nullopt;
      const bool bright = grey(y, x) > (low + high) / 2;
      if (ring(x, y) == 1)
        wrong += bright;
      else
        code = code << 1 | static_cast<std::uint64_t>(bright);
    }
  if (wrong > side / 2) return std::nullopt;
  return book.match(code);
}

} // namespace patina
