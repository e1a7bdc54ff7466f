// Figures: size, resolution, background and parts, and a view that returns to its window.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include <vtkNew.h>
#include <vtkRendererCollection.h>

#include "core/error.h"
#include "core/file.h"
#include "geometry/mesh/shapes.h"
#include "picture/picture_support.h"
#include "pictures/picture_file.h"
#include "support/fresh_folder.h"
#include "visualization/view/figure_picture.h"
#include "visualization/view/vector_figure.h"

namespace patina {
namespace {

constexpr double kTorusMajor = 0.035, kTorusMinor = 0.015;

class FigureTest : public ::testing::Test {
 protected:
  void SetUp() override {
    PATINA_NEEDS_DISPLAY();
    folder_ = test::freshFolder("figure");
    view_.setMesh(std::make_shared<TriangleMesh>(torus(kTorusMajor, kTorusMinor, 160, 80)));
    view_.showOnly({Layer::mesh, Layer::scale});
    view_.setView(ViewPreset::plus_z);
  }
  void TearDown() override {
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }
  static Figure sized(const FigureWidth& width, FigureBackground background) {
    Figure figure;
    setSize(figure, width, 4.0 / 3, 480);
    figure.background = background;
    return figure;
  }
  FigurePicture draw(const Figure& figure, const char* name) {
    FigurePicture picture = drawFigure(view_, figure);
    if (const char* keep = std::getenv("PATINA_KEEP_PICTURES"))
      writeFigure(picture, std::filesystem::path(keep) / (std::string(name) + ".png"));
    return picture;
  }
  static const std::uint8_t* at(const FigurePicture& picture, double x, double y) {
    const auto column = static_cast<std::size_t>(x * (picture.width - 1));
    const auto row = static_cast<std::size_t>(y * (picture.height - 1));
    return &picture.rgba[4 * (row * static_cast<std::size_t>(picture.width) + column)];
  }
  std::filesystem::path folder_;
  SceneView view_;
};

TEST(FigureSize, OfAWidthOnPaperIsRoundedToPixels) {
  Figure figure;
  setSize(figure, {.length = 0.085, .dpi = 300}, 923.0 / 638, 923);
  EXPECT_EQ(figure.width, 1004);
  EXPECT_EQ(figure.height, std::lround(1004 * 638 / 923.0));
  EXPECT_EQ(figure.dpi, 300);
  setSize(figure, {.length = 0.085, .scale = 4}, 2, 923);
  EXPECT_EQ(figure.width, std::lround(4 * 0.085 / 0.0254 * 300));
  EXPECT_EQ(figure.dpi, 1200) << "it has the same width on paper";
  setSize(figure, {.pixels = 923, .scale = 4}, 1, 923);
  EXPECT_EQ(figure.width, 4 * 923);
  EXPECT_EQ(figure.magnification, 4);
  EXPECT_FALSE(figure.dpi);
  EXPECT_THROW(setSize(figure, {.length = 3}, 1, 923), Error);
  EXPECT_THROW(parseFigureWidth("12.5"), Error);
  EXPECT_THROW(parseFigureWidth("-1mm"), Error);
  EXPECT_DOUBLE_EQ(parseFigureWidth("85mm").length.value(), 0.085);
}

TEST_F(FigureTest, TransparentOneHasAlphaZeroWhereNothingIs) {
  view_.showCube(true);
  const FigurePicture picture =
      draw(sized({.length = 0.085}, FigureBackground::transparent), "transparent");
  EXPECT_EQ(picture.width, 1004);
  EXPECT_EQ(at(picture, 0.99, 0.01)[3], 0) << "a corner";
  EXPECT_EQ(at(picture, 0.001, 0.999)[3], 0) << "beside the cube";
  EXPECT_EQ(at(picture, 0.5, 0.5)[3], 0) << "the hole of the torus";
  std::size_t opaque = 0, clear = 0, empty_color = 0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    opaque += picture.rgba[i + 3] == 255;
    clear += picture.rgba[i + 3] == 0;
    empty_color += picture.rgba[i + 3] == 0 && picture.rgba[i] == 0;
  }
  const double all = 1004.0 * picture.height;
  // The ring's area over the picture's: the outer diameter takes 1/1.08 of the height.
  const double scale = 1 / 1.08 / (2 * (kTorusMajor + kTorusMinor));
  const double ring = 4 * M_PI * kTorusMajor * kTorusMinor * scale * scale * 0.75;
  EXPECT_NEAR(static_cast<double>(opaque) / all, ring, 0.15 * ring);
  EXPECT_GT(static_cast<double>(opaque + clear) / all, 0.97) << "only edges are between";
  EXPECT_EQ(empty_color, clear);
  // Edges have the colour of what is drawn, not of a background.
  const auto* inside = at(picture, 0.5, 0.12);
  EXPECT_EQ(inside[3], 255);
  EXPECT_GT(inside[1], inside[2]) << "the surface's green";
}

TEST_F(FigureTest, AtFourTimesHasTheSameContentAndSharperTexts) {
  const FigurePicture once = draw(sized({.pixels = 480}, FigureBackground::white), "once");
  const FigurePicture four =
      draw(sized({.pixels = 480, .scale = 4}, FigureBackground::white), "four");
  ASSERT_EQ(four.width, 1920);
  ASSERT_EQ(four.height, 4 * once.height);
  double difference = 0;
  for (int y = 0; y < once.height; ++y)
    for (int x = 0; x < once.width; ++x) {
      double mean = 0;
      for (int dy = 0; dy < 4; ++dy)
        for (int dx = 0; dx < 4; ++dx)
          mean += four.rgba[4 * static_cast<std::size_t>((4 * y + dy) * four.width + 4 * x + dx)];
      difference +=
          std::abs(mean / 16 - once.rgba[4 * static_cast<std::size_t>(y * once.width + x)]);
    }
  EXPECT_LT(difference / (once.width * once.height), 2.5) << "levels of 255";
  // Steps from one pixel to the next in the text of the scale bar; a magnified text has a quarter.
  const auto darkest = [](const FigurePicture& picture) {
    int step = 0;
    for (int y = int(0.9 * picture.height); y < picture.height; ++y)
      for (int x = int(0.2 * picture.width); x + 1 < picture.width; ++x) {
        const auto i = 4 * static_cast<std::size_t>(y * picture.width + x);
        step = std::max(step, std::abs(picture.rgba[i] - picture.rgba[i + 4]));
      }
    return step;
  };
  EXPECT_GT(darkest(four), 150);
}

TEST_F(FigureTest, LeavesOutPartsAndHasAWhiteBackground) {
  Figure figure = sized({.pixels = 480}, FigureBackground::white);
  const auto ink = [](const FigurePicture& picture, double x0, double x1, double y0) {
    int found = 0;
    for (double y = y0; y < 1; y += 0.001)
      for (double x = x0; x < x1; x += 0.001) found += at(picture, x, y)[1] < 200;
    return found;
  };
  const FigurePicture with = draw(figure, "with");
  EXPECT_EQ(at(with, 0.99, 0.01)[0], 255);
  EXPECT_GT(ink(with, 0, 0.13, 0.75), 20) << "the axes";
  EXPECT_GT(ink(with, 0.22, 0.34, 0.93), 20) << "the scale bar";
  figure.without = parseFigureParts("cube,scale");
  const FigurePicture without = draw(figure, "without");
  EXPECT_EQ(ink(without, 0, 0.13, 0.75), 0);
  EXPECT_EQ(ink(without, 0.22, 0.34, 0.93), 0);
}

TEST_F(FigureTest, ReturnsTheViewToItsWindow) {
  const vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetSize(300, 200);
  view_.attachTo(*window);
  view_.fit();
  view_.prepare();
  window->Render();
  const double place = view_.renderer().GetActiveCamera()->GetDistance();
  drawFigure(view_, sized({.pixels = 400}, FigureBackground::transparent));
  EXPECT_EQ(view_.renderer().GetRenderWindow(), window.Get());
  EXPECT_EQ(view_.renderer().GetActiveCamera()->GetDistance(), place);
  EXPECT_TRUE(view_.prepare()) << "it must be drawn again";
  window->Render();
  EXPECT_EQ(view_.backgroundStyle().low, palette::kLight.low);
  while (vtkRenderer* renderer = window->GetRenderers()->GetFirstRenderer())
    window->RemoveRenderer(renderer);
}

TEST_F(FigureTest, FilesTellPixelsAlphaAndResolution) {
  const FigurePicture drawn =
      drawFigure(view_, sized({.length = 0.02, .dpi = 300}, FigureBackground::transparent));
  for (const char* name : {"figure.png", "figure.tif"}) {
    const auto path = folder_ / name;
    writeFigure(drawn, path);
    const Picture read = readPicture(path);
    ASSERT_EQ(read.width, drawn.width) << name;
    ASSERT_EQ(read.height, drawn.height) << name;
    ASSERT_EQ(read.channels, 4) << name;
    double difference = 0;
    for (int y = 0; y < read.height; ++y)
      for (int i = 0; i < 4 * read.width; ++i)
        difference = std::max<double>(
            difference, std::abs(255 * read.texel[static_cast<std::size_t>(
                                           (read.height - 1 - y) * 4 * read.width + i)] -
                                 drawn.rgba[static_cast<std::size_t>(y * 4 * read.width + i)]));
    EXPECT_LT(difference, 0.51) << name;
  }
  const std::string png = readFile(folder_ / "figure.png");
  const auto chunk = png.find("pHYs");
  ASSERT_NE(chunk, png.npos);
  EXPECT_EQ(png.substr(chunk + 4, 9), std::string("\0\0\x2e\x23\0\0\x2e\x23\x01", 9))
      << "11811 pixels per metre";
  const std::string tiff = readFile(folder_ / "figure.tif");
  EXPECT_NE(tiff.find(std::string("\xe0\x93\x04\0\xe8\x03\0\0", 8)), tiff.npos)
      << "300000/1000 per inch";
  EXPECT_THROW(writeFigure(drawn, folder_ / "figure.gif"), Error);
}

TEST_F(FigureTest, KeepsTextsAndTheScaleBarAsVectorsInDrawings) {
  const Figure figure = sized({.length = 0.085}, FigureBackground::transparent);
  writeVectorFigure(view_, figure, folder_ / "figure.svg");
  writeVectorFigure(view_, figure, folder_ / "figure.pdf");
  const std::string svg = readFile(folder_ / "figure.svg"), pdf = readFile(folder_ / "figure.pdf");
  if (const char* keep = std::getenv("PATINA_KEEP_PICTURES"))
    for (const char* name : {"figure.svg", "figure.pdf"})
      std::filesystem::copy_file(folder_ / name, std::filesystem::path(keep) / name,
                                 std::filesystem::copy_options::overwrite_existing);
  EXPECT_NE(svg.find("width=\"85.005mm\""), svg.npos) << svg.substr(0, 300);
  EXPECT_NE(svg.find(">20 mm</text>"), svg.npos);
  for (const char* axis : {">X</text>", ">Y</text>", ">Z</text>"})
    EXPECT_NE(svg.find(axis), svg.npos) << axis;
  EXPECT_NE(svg.find("<polyline"), svg.npos) << "the scale bar";
  EXPECT_NE(pdf.find("(20 mm) Tj"), pdf.npos);
  EXPECT_NE(pdf.find("/MediaBox [0 0 240.96 180.72]"), pdf.npos) << "1004 x 753 pixels at 300 dpi";
  EXPECT_NE(pdf.find("/SMask"), pdf.npos) << "transparent";
  // The picture below has no text, and later pictures have it again.
  EXPECT_EQ(drawFigure(view_, figure).rgba, drawFigure(view_, figure).rgba);
  const FigurePicture again = drawFigure(view_, figure);
  int dark = 0;
  for (double x = 0.25; x < 0.5; x += 0.001) {
    const auto* pixel = at(again, x, 0.955);
    dark += pixel[3] == 255 && pixel[0] < 60;
  }
  EXPECT_GT(dark, 10) << "the scale bar";
}

} // namespace
} // namespace patina
