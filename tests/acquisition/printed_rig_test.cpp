// Printed rigs: the body fits its markers, and what stands on the paper is what the tracker finds.
#include "acquisition/printing/printed_rig.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include "acquisition/files/frame_files.h"
#include "acquisition/tracking/marker_code.h"
#include "acquisition/tracking/marker_finder.h"
#include "core/error.h"
#include "core/file.h"
#include "geometry/mesh/mesh_report.h"
#include "support/fresh_folder.h"

namespace patina {
namespace {

const RigShape kShapes[] = {RigShape::cube, RigShape::pen, RigShape::dodecahedron};

RigPlan planOf(RigShape shape) {
  RigPlan plan;
  plan.shape = shape;
  plan.size = 0.03;
  return plan;
}

double volumeOf(const TriangleMesh& mesh) {
  double six = 0;
  for (const Triangle& t : mesh.triangles) {
    const auto at = [&](std::size_t i) { return mesh.positions[static_cast<std::size_t>(t[i])]; };
    six += at(0).dot(at(1).cross(at(2)));
  }
  return six / 6;
}

TEST(PrintedRig, HoldersAreClosedBodiesWithTheVolumeOfTheirSolids) {
  const double s = 0.03, bore = 0.01, wall = 2e-3;
  // Regular 48-gons in place of circles.
  const double disc = 24 * std::sin(2 * 3.14159265358979323846 / 48);
  const double edge = std::sqrt(2.0) * s * std::tan(3.14159265358979323846 / 5);
  struct Body {
    double volume, below;
  };
  const Body bodies[] = {{s * s * s, s / 2},
                         {1.5 * std::sqrt(3.0) * s * s * 2 * s, s},
                         {(15 + 7 * std::sqrt(5.0)) / 4 * edge * edge * edge,
                          edge * std::sqrt(250 + 110 * std::sqrt(5.0)) / 20}};
  for (std::size_t i = 0; i < 3; ++i) {
    const PrintedRig rig = printedRig(planOf(kShapes[i]));
    const MeshReport report = inspect(rig.holder);
    EXPECT_TRUE(report.watertight);
    EXPECT_EQ(report.components, 1u);
    const double depth = 0.75 * bodies[i].below, outer = bore / 2 + wall, inner = bore / 2;
    const double expected =
        bodies[i].volume + disc * depth * outer * outer - disc * 2 * depth * inner * inner;
    EXPECT_NEAR(volumeOf(rig.holder), expected, 1e-9 * expected) << i;
  }
}

TEST(PrintedRig, MarkersLieOnTheirFacesAndFaceOutward) {
  const std::size_t counts[] = {5, 13, 11};
  for (std::size_t i = 0; i < 3; ++i) {
    const PrintedRig rig = printedRig(planOf(kShapes[i]));
    ASSERT_EQ(rig.markers.size(), counts[i]);
    for (const PrintedRig::Face& face : rig.faces)
      for (const std::size_t m : face.markers) {
        const Pose inside = face.probe_from_face.inverse() * rig.markers[m].probe_from_marker;
        EXPECT_LT((inside.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
        EXPECT_NEAR(inside.translation().z(), 0, 1e-12);
        const Vec3 outward = rig.markers[m].probe_from_marker.linear().col(2);
        EXPECT_GT(outward.dot(rig.markers[m].probe_from_marker.translation()), 0);
        // The corners of the white margin are within the face.
        const double half = 0.015;
        for (const Vec2& sign : {Vec2(1, 1), Vec2(-1, 1), Vec2(-1, -1), Vec2(1, -1)}) {
          const Vec2 p = inside.translation().head<2>() + half * sign;
          for (std::size_t k = 0; k < face.outline.size(); ++k) {
            const Vec2 &a = face.outline[k], &b = face.outline[(k + 1) % face.outline.size()];
            EXPECT_GT(cross(Vec2(b - a), Vec2(p - a)), -1e-12);
          }
        }
      }
  }
}

TEST(PrintedRig, RefusesWhatDoesNotFit) {
  RigPlan plan;
  plan.bore = 0.033;
  EXPECT_THROW(printedRig(plan), Error);
  plan = {};
  plan.tip = 0.02;
  EXPECT_THROW(printedRig(plan), Error);
  plan = {};
  plan.family = "no_such";
  EXPECT_THROW(printedRig(plan), Error);
  plan = {};
  plan.size = 0.19;
  EXPECT_THROW(sheetsOf(printedRig(plan)), Error);
  EXPECT_THROW(sheetOf(parseBoard("charuco:12x9:40mm:20mm:5x5_50")), Error);
}

// Poppler shares no code with what has written the page.
GreyFrame pictureOf(const std::filesystem::path& pdf, int page, int dpi) {
  const std::string base = pdf.string() + "-" + std::to_string(page);
  const std::string command = "pdftoppm -gray -png -singlefile -r " + std::to_string(dpi) + " -f " +
                              std::to_string(page) + " '" + pdf.string() + "' '" + base + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << "is poppler-utils installed?";
  return readGrey(base + ".png");
}

TEST(PrintedRig, EveryMarkerOfTheSheetIsFoundInItsSize) {
  const std::filesystem::path folder = test::freshFolder("sheets");
  for (const RigShape shape : kShapes) {
    const PrintedRig rig = printedRig(planOf(shape));
    const int dpi = shape == RigShape::cube ? 600 : 300;
    const double pixel = 0.0254 / dpi;
    const std::vector<PrintedPage> pages = sheetsOf(rig);
    std::string bytes;
    ASSERT_EQ(printerLibrary().pdf(pages, bytes), "");
    const std::filesystem::path file = folder / "markers.pdf";
    writeFileAtomically(file, bytes);
    std::vector<int> seen(rig.markers.size());
    for (std::size_t page = 0; page < pages.size(); ++page) {
      const GreyFrame picture = pictureOf(file, static_cast<int>(page) + 1, dpi);
      EXPECT_NEAR(picture.width * pixel, 0.210, 2 * pixel);
      const std::vector<CodeBook> books{CodeBook(markerFamily("4x4_50"))};
      for (const SeenMarker& found : findMarkers(picture, books, nullptr)) {
        ++seen.at(static_cast<std::size_t>(found.id));
        for (std::size_t k = 0; k < 4; ++k) {
          const double side =
              (found.corner[k].pixel - found.corner[(k + 1) % 4].pixel).norm() * pixel;
          EXPECT_NEAR(side, rig.markers[static_cast<std::size_t>(found.id)].size, 0.05e-3);
        }
      }
    }
    EXPECT_EQ(seen, std::vector<int>(rig.markers.size(), 1));
  }
  std::filesystem::remove_all(folder);
}

TEST(PrintedRig, BoardOfTheSheetIsFoundInItsSize) {
  constexpr double kPixel = 0.0254 / 300;
  const std::filesystem::path folder = test::freshFolder("board");
  const Board board = parseBoard("charuco:8x5:32mm:24mm:5x5_50");
  std::string bytes;
  ASSERT_EQ(printerLibrary().pdf({sheetOf(board)}, bytes), "");
  writeFileAtomically(folder / "board.pdf", bytes);
  const auto view = findBoard(pictureOf(folder / "board.pdf", 1, 300), board);
  ASSERT_TRUE(view);
  ASSERT_EQ(view->pixel.size(), 28u);
  for (std::size_t i = 1; i < view->pixel.size(); ++i)
    EXPECT_NEAR((view->pixel[i] - view->pixel[0]).norm() * kPixel,
                (view->board[i] - view->board[0]).norm(), 0.05e-3);
  std::filesystem::remove_all(folder);
}

} // namespace
} // namespace patina
