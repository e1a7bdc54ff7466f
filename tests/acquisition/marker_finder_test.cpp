#include "acquisition/tracking/marker_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "acquisition/files/frame_files.h"
#include "acquisition/tracking/lens.h"
#include "core/error.h"
#include "support/least_time.h"
#include "support/rendered_rig.h"
#include "support/shared_data.h"

namespace patina {
namespace {

struct Found {
  int shown = 0, found = 0, wrong = 0;
  double squares = 0; // sum over all found corners [px^2]
  double rms() const { return std::sqrt(squares / (4. * found)); }
};

// Markers count as shown if their face is seen at 45 degrees or more.
Found findIn(const test::RenderedRig& rig, const FrameLook& look, double distance, int frames) {
  std::mt19937 random(5);
  Found result;
  for (int i = 0; i < frames; ++i) {
    const Pose pose = test::somePose(random, distance);
    const GreyFrame image = rig.renderer.render({pose}, look, static_cast<std::uint32_t>(i));
    const auto seen = findMarkers(image, rig.books, &rig.camera);
    for (const RigMarker& marker : rig.markers) {
      const Pose face = pose * marker.probe_from_marker;
      if (-face.linear().col(2).dot(face.translation().normalized()) < 0.7) continue;
      ++result.shown;
      const auto is = [&](const SeenMarker& s) { return s.id == marker.id; };
      const auto found = std::find_if(seen.begin(), seen.end(), is);
      if (found == seen.end()) continue;
      ++result.found;
      for (std::size_t c = 0; c < 4; ++c)
        result.squares += (found->corner[c].pixel - pixelOf(rig.camera, pose * marker.corners()[c]))
                              .squaredNorm();
    }
    result.wrong += static_cast<int>(seen.size()) > 3; // at most three faces of a cube are visible
  }
  return result;
}

struct Setting {
  const char* name;
  Camera camera;
  const char* family;
  FrameLook look;
  double distance, most; // corner rms [px]
};

FrameLook lookOf(double blur, double noise, double shade, double white = 0.85) {
  FrameLook look;
  look.blur = blur, look.noise = noise, look.shade = shade, look.white = white;
  return look;
}

// The limits are about twice the measured errors for each camera, lens, light and family.
TEST(MarkerFinder, FindsCornersToHundredthsOfAPixel) {
  const Setting settings[] = {
      {"april", test::smallCamera(), "apriltag_36h11", lookOf(0.6, 2, 0.3), 0.4, 0.06},
      {"aruco", test::smallCamera(), "4x4_50", lookOf(0.6, 2, 0.3), 0.4, 0.06},
      {"large", test::largeCamera(), "apriltag_36h11", lookOf(0.8, 2, 0.3), 0.4, 0.05},
      {"wide", test::wideCamera(), "5x5_100", lookOf(0.6, 2, 0.3), 0.3, 0.06},
      {"blurred", test::smallCamera(), "4x4_50", lookOf(1.5, 2, 0.3), 0.4, 0.25},
      {"noisy", test::smallCamera(), "4x4_50", lookOf(0.6, 8, 0.3), 0.4, 0.1},
      {"uneven and dim", test::smallCamera(), "6x6_250", lookOf(0.6, 2, 0.9, 0.4), 0.4, 0.15},
  };
  for (const Setting& s : settings) {
    const Found found = findIn(test::RenderedRig(s.camera, s.family), s.look, s.distance, 12);
    std::printf("%-16s %2d of %2d, corners %.3f px\n", s.name, found.found, found.shown,
                found.rms());
    EXPECT_EQ(found.found, found.shown) << s.name;
    EXPECT_EQ(found.wrong, 0) << s.name;
    EXPECT_LT(found.rms(), s.most) << s.name;
  }
}

TEST(MarkerFinder, FindsSmallMarkersIfThorough) {
  const test::RenderedRig rig(test::smallCamera(), "apriltag_36h11", 0.03);
  std::mt19937 random(2);
  int quick = 0, thorough = 0;
  for (int i = 0; i < 6; ++i) { // 12 px a side, 1.5 px a bit
    const GreyFrame image =
        rig.renderer.render({test::somePose(random, 1.2, 0.3)}, lookOf(0.5, 2, 0.3), 1);
    quick += !findMarkers(image, rig.books, &rig.camera).empty();
    thorough += !findMarkers(image, rig.books, &rig.camera, {true}).empty();
  }
  EXPECT_GE(thorough, quick);
  EXPECT_GE(thorough, 5);
}

TEST(MarkerFinder, SeesNothingInNoiseAndBlankFrames) {
  const std::vector<CodeBook> books{CodeBook(markerFamily("apriltag_36h11"))};
  GreyFrame image{320, 240, std::vector<std::uint8_t>(320 * 240, 90)};
  EXPECT_TRUE(findMarkers(image, books, nullptr, {true}).empty());
  std::mt19937 random(1);
  for (auto& pixel : image.pixel) pixel = static_cast<std::uint8_t>(random() & 255);
  EXPECT_TRUE(findMarkers(image, books, nullptr, {true}).empty());
  const GreyFrame tiny{3, 2, std::vector<std::uint8_t>(6, 0)};
  EXPECT_TRUE(findMarkers(tiny, books, nullptr, {true}).empty());
}

TEST(CodeBook, CorrectsWrongBitsUpToItsLimit) {
  const MarkerFamily& family = markerFamily("apriltag_36h11");
  const CodeBook book(family);
  ASSERT_EQ(family.max_correction, 3);
  for (const int id : {0, 17, 586}) {
    std::uint64_t code = family.code[static_cast<std::size_t>(id)];
    for (int wrong = 0; wrong <= 4; ++wrong) {
      const auto match = book.match(code);
      ASSERT_EQ(match.has_value(), wrong <= 3) << wrong;
      if (match) {
        EXPECT_EQ(match->id, id);
        EXPECT_EQ(match->quarter_turns, 0);
        EXPECT_EQ(match->hamming_distance, wrong);
      }
      code ^= std::uint64_t{1} << (7 * wrong + 2);
    }
  }
}

TEST(MarkerFamily, ListsTheKnownFamilies) {
  try {
    (void)markerFamily("7x9_3");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("apriltag_36h11"), std::string::npos);
  }
}

Vec2 middleOf(const SeenMarker& marker) {
  Vec2 sum = Vec2::Zero();
  for (const FittedCorner& corner : marker.corner) sum += corner.pixel / 4;
  return sum;
}

TEST(MarkerFinder, FindsTheMarkersThatAprilTagFindsOnTheSharedPhotograph) {
  const auto path = test::sharedData("markers/apriltag_34139872896_defdb2f8d9_c.jpg");
  PATINA_SKIP_WITHOUT(path);
  const GreyFrame image = readGrey(path);
  const std::vector<CodeBook> books{CodeBook(markerFamily("apriltag_36h11"))};
  EXPECT_GE(findMarkers(image, books, nullptr).size(), 7u) << "AprilTag, decimate 2: 7";
  const auto thorough = findMarkers(image, books, nullptr, {true});
  EXPECT_GE(thorough.size(), 10u) << "AprilTag, decimate 1: 10";
  const Vec2 known[] = {{422, 305}, {400, 429}, {597, 410}, {687, 438}, {731, 441},
                        {696, 351}, {308, 423}, {427, 262}, {680, 365}, {638, 410}};
  for (const Vec2& middle : known)
    EXPECT_TRUE(std::any_of(thorough.begin(), thorough.end(), [&](const SeenMarker& marker) {
      return (middleOf(marker) - middle).norm() < 3 && marker.id == 0;
    })) << middle.transpose();
}

TEST(MarkerFinder, FindsEachMarkerOfTheSharedBoardOnce) {
  const auto path = test::sharedData("markers/choriginal.jpg");
  PATINA_SKIP_WITHOUT(path);
  const auto seen = findMarkers(readGrey(path), {CodeBook(markerFamily("6x6_250"))}, nullptr);
  std::set<int> ids;
  for (const SeenMarker& marker : seen) ids.insert(marker.id);
  EXPECT_EQ(seen.size(), 17u);
  EXPECT_EQ(ids.size(), 17u);
}

PATINA_TIMED_TEST(MarkerFinder, TakesHardlyLongerUnderNoiseAndLosesNoMarker) {
  const test::RenderedRig rig(test::smallCamera(), "4x4_50");
  std::mt19937 random(5);
  const Pose pose = test::somePose(random, 0.4);
  const auto frame = [&](double noise) {
    FrameLook look;
    look.noise = noise;
    return rig.renderer.render({pose}, look, 1);
  };
  const GreyFrame clear = frame(2), noisy = frame(8), noisier = frame(20);
  const auto looking = [&](const GreyFrame& image) {
    return [&] { (void)findMarkers(image, rig.books, &rig.camera); };
  };
  const auto times = test::minSeconds({looking(clear), looking(noisy), looking(noisier)});
  std::printf("noise of 8 takes %.2f of that of 2, of 20 %.2f\n", times[1] / times[0],
              times[2] / times[0]);
  EXPECT_LT(times[1] / times[0], 1.5);
  EXPECT_LT(times[2] / times[0], 3);
  int shown = 0;
  for (const double distance : {0.25, 0.4, 0.6, 0.9}) {
    const Found clean = findIn(rig, lookOf(0.6, 2, 0.3), distance, 6);
    const Found found = findIn(rig, lookOf(0.6, 8, 0.3), distance, 6);
    EXPECT_GE(found.found, clean.found) << distance;
    EXPECT_EQ(found.wrong, 0);
    shown += clean.found;
  }
  EXPECT_GT(shown, 20);
}

} // namespace
} // namespace patina
