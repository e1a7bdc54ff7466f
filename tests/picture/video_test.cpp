// A replay of a recording as a video.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include <vtkPNGWriter.h>

#include "core/error.h"
#include "core/file.h"
#include "geometry/mesh/shapes.h"
#include "picture/picture_support.h"
#include "support/fresh_folder.h"
#include "support/small_disk.h"
#include "visualization/export/export_files.h"
#include "visualization/plots/replay_plot.h"
#include "visualization/plots/video.h"

namespace patina {
namespace {

// A tip that goes down to a torus and presses it in one second.
std::vector<ToolSample> pressingDown() {
  std::vector<ToolSample> samples(1001);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ToolSample& s = samples[i];
    s.t = 5 + 1e-3 * static_cast<double>(i);
    s.tip = Vec3(0, -0.035, 0.03 - 2e-5 * static_cast<double>(i));
    s.vcp = s.surface = s.tip;
    s.contact = s.tip.z() < 0.015;
    if (!s.contact) continue;
    s.vcp = s.surface = Vec3(0, -0.035, 0.015);
    s.normal = Vec3::UnitZ();
    s.depth = 0.015 - s.tip.z();
    s.force = Vec3(0, 0, 300 * s.depth);
  }
  return samples;
}

class VideoTest : public ::testing::Test {
 protected:
  void SetUp() override {
    PATINA_NEEDS_DISPLAY();
    folder_ = test::freshFolder("video");
    view_.setMesh(std::make_shared<TriangleMesh>(torus(0.035, 0.015, 60, 30)));
    view_.showOnly({Layer::mesh, Layer::tip});
    view_.setView(ViewPreset::iso);
    figure_.width = 321; // odd sides grow by one
    figure_.height = 240;
  }
  void TearDown() override {
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }
  std::filesystem::path folder_;
  SceneView view_;
  Figure figure_;
};

TEST_F(VideoTest, HasAFrameEvery40MillisecondsAndAppearsWhenItIsComplete) {
  const auto path = folder_ / "press.ogv";
  VideoWriter video(view_, pressingDown(), figure_, path);
  EXPECT_EQ(video.frames(), 26);
  while (video.writeNext()) EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(video.written(), 26);
  EXPECT_FALSE(video.writeNext());
  const std::string bytes = readFile(path);
  EXPECT_EQ(bytes.substr(0, 4), "OggS");
  // Theora's identification header: the picture's sides, 24 bits each.
  const std::size_t header = bytes.find("\x80theora");
  ASSERT_NE(header, bytes.npos);
  const auto side = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = 0; i < 3; ++i)
      value = value << 8 | static_cast<unsigned char>(bytes[header + at + i]);
    return value;
  };
  EXPECT_EQ(side(14), 322);
  EXPECT_EQ(side(17), 240);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1) << "nothing else";
}

// The plot's line is where the sample's time is, and the curve's highest point at the last sample.
TEST_F(VideoTest, HasTheReplayPlotBesideThePicture) {
  const std::vector<ToolSample> samples = pressingDown();
  const ReplayPlot plot(samples, {160, 240}, 1);
  const auto blank = [](int wide, int high) {
    auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetDimensions(wide, high, 1);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    std::fill_n(static_cast<unsigned char*>(image->GetScalarPointer()), 3 * wide * high, 7);
    return image;
  };
  const auto picture = blank(200, 240);
  const auto isColor = [](const unsigned char* pixel, const palette::Color& color) {
    bool all = true;
    for (std::size_t c = 0; c < 3; ++c) all = all && std::abs(pixel[c] - 255 * color[c]) < 30;
    return all;
  };
  std::vector<double> lines;
  for (const std::size_t i : {0U, 250U, 500U, 1000U}) {
    const auto frame = plot.beside(*picture, samples[i]);
    ASSERT_EQ(frame->GetDimensions()[0], 360);
    ASSERT_EQ(frame->GetDimensions()[1], 240);
    const auto at = [&](int x, int y) {
      return static_cast<const unsigned char*>(frame->GetScalarPointer(x, y, 0));
    };
    EXPECT_EQ(at(199, 239)[0], 7);
    EXPECT_GT(at(201, 239)[0], 250);
    std::vector<int> columns;
    for (int x = 200; x < 360; ++x)
      if (isColor(at(x, 200), palette::kTool) && isColor(at(x, 100), palette::kTool))
        columns.push_back(x);
    ASSERT_EQ(columns.size(), 2U) << i;
    lines.push_back(0.5 * (columns.front() + columns.back()));
  }
  const double axis = lines[3] - lines[0];
  EXPECT_GT(axis, 60);
  EXPECT_NEAR(lines[1] - lines[0], axis / 4, 1);
  EXPECT_NEAR(lines[2] - lines[0], axis / 2, 1);
  const auto frame = plot.beside(*picture, samples[0]);
  if (const char* keep = std::getenv("PATINA_KEEP_PICTURES")) {
    const vtkNew<vtkPNGWriter> writer;
    writer->SetFileName((std::filesystem::path(keep) / "replay_plot.png").c_str());
    writer->SetInputData(ReplayPlot(samples, {320, 540}, 1).beside(*blank(640, 540), samples[700]));
    writer->Write();
  }
  int highest_x = 0;
  for (int y = 239; y > 0 && highest_x == 0; --y)
    for (int x = 200; x < 360; ++x) {
      const auto* pixel = static_cast<const unsigned char*>(frame->GetScalarPointer(x, y, 0));
      if (isColor(pixel, palette::kSeries[0])) highest_x = x;
    }
  EXPECT_NEAR(highest_x, lines[3], 2) << "the force grows to the end";
}

TEST_F(VideoTest, FailsOnADiskThatIsFullAndLeavesNothing) {
  for (const std::uintmax_t room : {std::uintmax_t{3000}, std::uintmax_t{20000}}) {
    const test::SmallDisk full(room);
    VideoWriter video(view_, pressingDown(), figure_, folder_ / "press.ogv");
    EXPECT_THROW(while (video.writeNext()){}, FileError) << room;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(VideoTest, IsNotLeftBehindWhenItIsCancelled) {
  {
    VideoWriter video(view_, pressingDown(), figure_, folder_ / "press.ogv");
    video.writeNext();
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
  EXPECT_THROW(VideoWriter(view_, {}, figure_, folder_ / "a.ogv"), Error);
  EXPECT_THROW(VideoWriter(view_, pressingDown(), figure_, folder_ / "a.avi"), Error);
}

TEST(ToolSamples, ReadBackAsTheyWereWritten) {
  const auto folder = test::freshFolder("samples");
  const std::vector<ToolSample> samples = pressingDown();
  writeToolSamplesCsv(folder / "a.csv", samples);
  const auto read = readToolSamplesCsv(folder / "a.csv");
  ASSERT_EQ(read.size(), samples.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].t, samples[i].t);
    EXPECT_EQ(read[i].tip, samples[i].tip);
    EXPECT_EQ(read[i].force, samples[i].force);
    EXPECT_EQ(read[i].vcp, samples[i].vcp);
    EXPECT_EQ(read[i].contact, samples[i].contact);
    EXPECT_NEAR((read[i].surface - samples[i].surface).norm(), 0, 1e-12);
  }
  std::filesystem::remove_all(folder);
}

} // namespace
} // namespace patina
