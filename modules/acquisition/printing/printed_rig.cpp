#include "acquisition/printing/printed_rig.h"

#include <cmath>
#include <numbers>

#include "acquisition/tracking/marker_code.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

using Face = PrintedRig::Face;
using std::numbers::pi;

constexpr double kWall = 2e-3; // thickness of the tube [m]
constexpr int kAround = 48;    // corners of the tube
constexpr double kDegree = pi / 180;

Vec2 at(double radius, double angle) {
  return radius * Vec2(std::cos(angle), std::sin(angle));
}

// A regular polygon by the radius of its corners and the angle of the first one.
std::vector<Vec2> polygon(int corners, double radius, double first) {
  std::vector<Vec2> points;
  for (int i = 0; i < corners; ++i) points.push_back(at(radius, first + 2 * pi * i / corners));
  return points;
}

std::vector<Vec2> rectangle(double width, double height) {
  const double x = width / 2, y = height / 2;
  return {{x, y}, {-x, y}, {-x, -y}, {x, -y}};
}

// A face at `distance` from the origin whose y axis points upward as far as it can. For faces that
// look up or down it is the y axis of the probe's frame, turned about x.
Face faceTowards(const Vec3& normal, double distance, std::vector<Vec2> outline) {
  Face face;
  const bool level = std::abs(normal.z()) > 0.999;
  const Vec3 up =
      level ? Vec3(0, normal.z(), 0) : Vec3(Vec3::UnitZ() - normal.z() * normal).normalized();
  Eigen::Matrix3d axes;
  axes << up.cross(normal), up, normal;
  face.probe_from_face.linear() = axes;
  face.probe_from_face.translation() = distance * normal;
  face.outline = std::move(outline);
  return face;
}

Vec3 direction(double polar, double azimuth) {
  return {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
          std::cos(polar)};
}

// The faces of a body: the one with the bore, the opposite one, then round the z axis.
std::vector<Face> facesOf(RigShape shape, double size) {
  std::vector<Face> faces;
  switch (shape) {
  case RigShape::cube:
    for (const Vec3& normal : {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0),
                               Vec3(-1, 0, 0), Vec3(0, -1, 0)})
      faces.push_back(faceTowards(normal, size / 2, rectangle(size, size)));
    break;
  case RigShape::pen:
    for (const double z : {-1.0, 1.0})
      faces.push_back(faceTowards({0, 0, z}, size, polygon(6, size, pi / 6)));
    for (int i = 0; i < 6; ++i)
      faces.push_back(faceTowards(direction(pi / 2, i * pi / 3), size * std::sqrt(0.75),
                                  rectangle(size, 2 * size)));
    break;
  case RigShape::dodecahedron: {
    const double inner = size / std::sqrt(2.0); // radius of the circle in a face
    const double corner = inner / std::cos(pi / 5), edge = 2 * inner * std::tan(pi / 5);
    const double distance = edge * std::sqrt(250 + 110 * std::sqrt(5.0)) / 20;
    const double polar = std::atan(2.0); // between the normals of neighbours
    faces.push_back(faceTowards({0, 0, -1}, distance, polygon(5, corner, 0)));
    faces.push_back(faceTowards({0, 0, 1}, distance, polygon(5, corner, pi / 5)));
    for (int i = 0; i < 5; ++i)
      faces.push_back(faceTowards(direction(polar, 2 * pi * i / 5), distance,
                                  polygon(5, corner, 126 * kDegree)));
    for (int i = 0; i < 5; ++i)
      faces.push_back(faceTowards(direction(pi - polar, pi / 5 + 2 * pi * i / 5), distance,
                                  polygon(5, corner, 306 * kDegree)));
    break;
  }
  }
  return faces;
}

// Triangles between two loops of corners that go round the same way, by their angles.
class HolderMesh {
 public:
  TriangleMesh mesh;

  std::int32_t corner(const Vec3& p) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      if ((mesh.positions[i] - p).norm() < 1e-9) return static_cast<std::int32_t>(i);
    mesh.positions.push_back(p);
    return static_cast<std::int32_t>(mesh.positions.size()) - 1;
  }
  std::vector<std::int32_t> loop(const Face& face, const std::vector<Vec2>& points, double height) {
    std::vector<std::int32_t> corners;
    for (const Vec2& p : points)
      corners.push_back(corner(face.probe_from_face * Vec3(p.x(), p.y(), height)));
    return corners;
  }
  void fill(const std::vector<std::int32_t>& loop) {
    for (std::size_t i = 2; i < loop.size(); ++i)
      mesh.triangles.push_back({loop[0], loop[i - 1], loop[i]});
  }
  void join(const std::vector<std::int32_t>& outer, const std::vector<std::int32_t>& inner) {
    const std::size_t m = outer.size(), n = inner.size();
    for (std::size_t i = 0, j = 0; i < m || j < n;) {
      // The loop whose next corner comes first goes on to it.
      if (j == n || (i < m && (i + 1) * n <= (j + 1) * m)) {
        mesh.triangles.push_back({outer[i % m], outer[(i + 1) % m], inner[j % n]});
        ++i;
      } else {
        mesh.triangles.push_back({outer[i % m], inner[(j + 1) % n], inner[j % n]});
        ++j;
      }
    }
  }
};

// The body, and below its first face a tube as long as the bore is deep in the body.
TriangleMesh holderOf(const std::vector<Face>& faces, double bore, double depth) {
  HolderMesh holder;
  for (std::size_t i = 1; i < faces.size(); ++i)
    holder.fill(holder.loop(faces[i], faces[i].outline, 0));
  const Face& below = faces.front();
  const double first = std::atan2(below.outline[0].y(), below.outline[0].x());
  const auto circle = [&](double radius, double height) {
    return holder.loop(below, polygon(kAround, radius, first), height);
  };
  const auto end = circle(bore / 2, -depth);
  const std::vector<std::vector<std::int32_t>> loops = {
      holder.loop(below, below.outline, 0), circle(bore / 2 + kWall, 0),
      circle(bore / 2 + kWall, depth), circle(bore / 2, depth), end};
  for (std::size_t i = 1; i < loops.size(); ++i) holder.join(loops[i - 1], loops[i]);
  holder.fill(end);
  return holder.mesh;
}

// Radius of the largest circle about the middle of a face.
double innerRadius(const Face& face) {
  double radius = face.outline[0].norm();
  for (std::size_t i = 0; i < face.outline.size(); ++i) {
    const Vec2 &a = face.outline[i], &b = face.outline[(i + 1) % face.outline.size()];
    radius = std::min(radius, std::abs(a.x() * b.y() - a.y() * b.x()) / (b - a).norm());
  }
  return radius;
}

constexpr double kPageWidth = 0.21, kPageHeight = 0.297, kMargin = 0.012, kGap = 5e-3;
constexpr double kHair = 0.1e-3; // width of a line to cut along [m]
constexpr double kWordsHeight = 3e-3;

Eigen::AlignedBox2d boxAt(const Vec2& corner, const Vec2& size) {
  return {corner, Vec2(corner + size)};
}

// Adds the black parts of a marker, whose black square is `size` wide and has its middle at
// `middle` on the page.
void addMarker(const MarkerFamily& family, int id, double size, const Vec2& middle,
               PrintedPage::Area& black) {
  const int side = family.side + 2;
  const double bit = size / side;
  const std::uint64_t code = family.code[static_cast<std::size_t>(id)];
  const auto isBlack = [&](int row, int column) {
    if (row == 0 || column == 0 || row == side - 1 || column == side - 1) return true;
    const int place = (row - 1) * family.side + column - 1;
    return (code >> (family.side * family.side - 1 - place) & 1) == 0;
  };
  for (int row = 0; row < side; ++row)
    for (int from = 0, to = 0; from < side; from = ++to) {
      while (from < side && !isBlack(row, from)) ++from;
      for (to = from; to < side && isBlack(row, to);) ++to;
      if (to > from)
        black.parts.push_back(boxAt(middle + Vec2(from * bit - size / 2, row * bit - size / 2),
                                    Vec2((to - from) * bit, bit)));
    }
}

void addFace(const PrintedRig& rig, const Face& face, const Vec2& middle, PrintedPage& page) {
  // The face's y axis points up, the page's down.
  const auto onPage = [&](double x, double y) { return Vec2(middle + Vec2(x, -y)); };
  PrintedPage::Outline outline{{}, kHair};
  double bottom = 0;
  for (const Vec2& p : face.outline) {
    outline.points.push_back(onPage(p.x(), p.y()));
    bottom = std::max(bottom, -p.y());
  }
  page.outlines.push_back(std::move(outline));
  std::string ids;
  for (const std::size_t i : face.markers) {
    const RigMarker& marker = rig.markers[i];
    const Vec3 place = face.probe_from_face.inverse() * marker.probe_from_marker.translation();
    addMarker(markerFamily(marker.family), marker.id, marker.size, onPage(place.x(), place.y()),
              page.areas.front());
    ids += (ids.empty() ? "" : ", ") + std::to_string(marker.id);
  }
  page.words.push_back(
      {onPage(-0.5 * kWordsHeight * static_cast<double>(ids.size()) / 2, -bottom - 3.6e-3),
       kWordsHeight, ids});
}

PrintedPage emptyPage(const std::string& title, const Vec2& size) {
  PrintedPage page;
  page.size = size;
  page.areas.push_back({0, {}});
  page.words.push_back({{kMargin, kMargin + kWordsHeight}, kWordsHeight, title});
  return page;
}

constexpr const char* kHowToPrint = "Print at 100 % (no fitting to the page). The ruler must be "
                                    "100 mm long, the square 20 mm wide.";
constexpr const char* kHowToGlue = "Glue 0 onto the end, its right edge at 1; the others follow "
                                   "anticlockwise as seen from the end, "
                                   "numbers towards the tip.";
constexpr double kRulerHeight = 0.028; // with the square beside it [m]

// A ruler of 100 mm, and a square of 20 mm.
void addRuler(const Vec2& corner, PrintedPage& page) {
  PrintedPage::Area& black = page.areas.front();
  constexpr double kLine = 0.2e-3;
  for (int mm = 0; mm <= 100; ++mm) {
    const double length = mm % 10 == 0 ? 6e-3 : mm % 5 == 0 ? 4.5e-3 : 3e-3;
    black.parts.push_back(boxAt(corner + Vec2(mm * 1e-3 - kLine / 2, 0), Vec2(kLine, length)));
    if (mm % 10 == 0)
      page.words.push_back({corner + Vec2(mm * 1e-3 - 1e-3, 9.5e-3), 2.5e-3, std::to_string(mm)});
  }
  black.parts.push_back(boxAt(corner + Vec2(0.12, 0), Vec2(0.02, 0.02)));
}

} // namespace

PrintedRig printedRig(const RigPlan& plan) {
  const MarkerFamily& family = markerFamily(plan.family);
  std::vector<Face> faces = facesOf(plan.shape, plan.size);
  const double most = 2 * (innerRadius(faces.front()) - kWall);
  if (!(plan.bore > 0 && plan.bore < most))
    throw Error("a bore of " + formatLength(plan.bore) +
                " does not fit into a body with markers of " + formatLength(plan.size) +
                "; at most " + formatLength(most) + " does");
  PrintedRig rig;
  const double depth = 0.75 * -faces.front().probe_from_face.translation().z();
  if (!(plan.tip > 1.75 / 0.75 * depth))
    throw Error("a tip at " + formatLength(plan.tip) +
                " from the body's middle is within the holder");
  rig.holder = holderOf(faces, plan.bore, depth);
  rig.tip = Vec3(0, 0, -plan.tip);
  faces.erase(faces.begin());
  for (Face& face : faces) {
    const bool two = plan.shape == RigShape::pen && face.outline.size() == 4;
    for (const double y : two ? std::vector{0.5, -0.5} : std::vector{0.0}) {
      RigMarker marker{plan.family, static_cast<int>(rig.markers.size()),
                       plan.size * (family.side + 2) / (family.side + 4), face.probe_from_face};
      marker.probe_from_marker.translate(Vec3(0, y * plan.size, 0));
      face.markers.push_back(rig.markers.size());
      rig.markers.push_back(marker);
    }
  }
  if (rig.markers.size() > family.code.size())
    throw Error("the family " + plan.family + " has " + std::to_string(family.code.size()) +
                " markers, and this rig needs " + std::to_string(rig.markers.size()));
  rig.faces = std::move(faces);
  return rig;
}

std::vector<PrintedPage> sheetsOf(const PrintedRig& rig) {
  const Vec2 page_size(kPageWidth, kPageHeight);
  std::vector<PrintedPage> pages;
  const double top = kMargin + 5 * kWordsHeight, end = kPageHeight - kMargin - kRulerHeight;
  Vec2 next(kMargin, top); // left upper corner of the next face
  double row_end = top;
  for (const Face& face : rig.faces) {
    Eigen::AlignedBox2d box;
    for (const Vec2& p : face.outline) box.extend(Vec2(p.x(), -p.y()));
    const Vec2 cell = box.sizes() + Vec2(kGap, kGap + kWordsHeight);
    if (cell.x() > kPageWidth - 2 * kMargin || cell.y() > end - top)
      throw Error("a face of " + formatLength(box.sizes().x()) + " by " +
                  formatLength(box.sizes().y()) + " does not fit onto A4; make it smaller");
    if (next.x() + cell.x() > kPageWidth - kMargin) next = Vec2(kMargin, row_end);
    if (pages.empty() || next.y() + cell.y() > end) {
      pages.push_back(emptyPage(kHowToPrint, page_size));
      pages.back().words.push_back(
          {{kMargin, kMargin + 2.5 * kWordsHeight}, kWordsHeight, kHowToGlue});
      addRuler({kMargin + 0.01, kPageHeight - kMargin - kRulerHeight + kGap}, pages.back());
      next = Vec2(kMargin, top);
      row_end = top;
    }
    addFace(rig, face, next - box.min(), pages.back());
    next.x() += cell.x();
    row_end = std::max(row_end, next.y() + cell.y());
  }
  return pages;
}

PrintedPage sheetOf(const Board& board) {
  const Vec2 size(board.columns * board.square, board.rows * board.square);
  if (size.x() > kPageHeight - 2 * kMargin ||
      size.y() > kPageWidth - 2 * kMargin - 2 * kWordsHeight)
    throw Error("a board of " + formatLength(size.x()) + " by " + formatLength(size.y()) +
                " does not fit onto A4");
  const MarkerFamily& family = markerFamily(board.family);
  PrintedPage page =
      emptyPage("charuco:" + std::to_string(board.columns) + "x" + std::to_string(board.rows) +
                    ":" + formatNumber(1e3 * board.square) +
                    "mm:" + formatNumber(1e3 * board.marker) + "mm:" + board.family +
                    "   Print at 100 %, glue it onto something flat, and measure a square.",
                Vec2(kPageHeight, kPageWidth));
  PrintedPage::Area& black = page.areas.front();
  const Vec2 corner((kPageHeight - size.x()) / 2, kMargin + 2 * kWordsHeight);
  int id = 0;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column) {
      const Vec2 square = corner + board.square * Vec2(column, row);
      if ((row + column) % 2 == 0)
        black.parts.push_back(boxAt(square, Vec2::Constant(board.square)));
      else if (static_cast<std::size_t>(id) >= family.code.size())
        throw Error("the family " + board.family + " has too few markers for the board");
      else
        addMarker(family, id++, board.marker, square + Vec2::Constant(board.square / 2), black);
    }
  return page;
}

} // namespace patina
