// Tracking against OpenCV's ArUco and the AprilTag library, all in one run on rendered frames.
#include <algorithm>
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <cmath>
#include <opencv2/calib3d.hpp>
#if __has_include(<opencv2/objdetect/aruco_detector.hpp>)
#include <opencv2/objdetect/aruco_detector.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

#include "acquisition/files/camera_file.h"
#include "acquisition/files/frame_files.h"
#include "acquisition/tracking/lens.h"
#include "support/least_time.h"
#include "support/rendered_rig.h"
#include "support/shared_data.h"

namespace patina {
namespace {

// Corners of a peer, in the marker's order, undistorted by our lens; the pose follows as for ours.
using Corners = std::vector<std::pair<int, std::array<Vec2, 4>>>;

std::vector<SeenMarker> seenOf(const Corners& corners, const Camera& camera) {
  std::vector<SeenMarker> seen;
  for (const auto& [id, pixel] : corners) {
    SeenMarker marker{"apriltag_36h11", id, 0, {}, 0};
    for (std::size_t i = 0; i < 4; ++i)
      marker.corner[i] = {pixel[i], undistortedPoint(camera, pixel[i]).value(),
                          10 * Eigen::Matrix2d::Identity()};
    seen.push_back(marker);
  }
  return seen;
}

class AprilTag {
 public:
  explicit AprilTag(float decimate)
      : family_(tag36h11_create()), detector_(apriltag_detector_create()) {
    apriltag_detector_add_family_bits(detector_, family_, 2);
    detector_->quad_decimate = decimate;
    detector_->nthreads = 1;
  }
  ~AprilTag() {
    apriltag_detector_destroy(detector_);
    tag36h11_destroy(family_);
  }
  AprilTag(const AprilTag&) = delete;
  AprilTag& operator=(const AprilTag&) = delete;

  Corners find(const GreyFrame& image) const {
    image_u8_t view = {image.width, image.height, image.width,
                       const_cast<std::uint8_t*>(image.row(0))};
    zarray_t* found = apriltag_detector_detect(detector_, &view);
    Corners corners;
    for (int i = 0; i < zarray_size(found); ++i) {
      apriltag_detection_t* one = nullptr;
      zarray_get(found, i, &one);
      // The centre of its first pixel is (0.5, 0.5), its corners run in the opposite order from
      // below, and OpenCV's codes are rotated by half a turn.
      std::array<Vec2, 4> pixel;
      for (std::size_t k = 0; k < 4; ++k)
        pixel[k] = Vec2(one->p[(5 - k) % 4][0] - 0.5, one->p[(5 - k) % 4][1] - 0.5);
      corners.emplace_back(one->id, pixel);
    }
    apriltag_detections_destroy(found);
    return corners;
  }

 private:
  apriltag_family_t* family_;
  apriltag_detector_t* detector_;
};

// OpenCV 4.7 changed the interface of its markers.
void findAruco(const cv::Mat& view, int family, int refinement,
               std::vector<std::vector<cv::Point2f>>& corners, std::vector<int>& ids) {
#if __has_include(<opencv2/objdetect/aruco_detector.hpp>)
  cv::aruco::DetectorParameters parameters;
  parameters.cornerRefinementMethod = refinement;
  cv::aruco::ArucoDetector(cv::aruco::getPredefinedDictionary(family), parameters)
      .detectMarkers(view, corners, ids);
#else
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = refinement;
  cv::aruco::detectMarkers(view, cv::aruco::getPredefinedDictionary(family), corners, ids,
                           parameters);
#endif
}

Corners findByAruco(const GreyFrame& image, int refinement) {
  const cv::Mat view(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.row(0)));
  std::vector<std::vector<cv::Point2f>> found;
  std::vector<int> ids;
  findAruco(view, cv::aruco::DICT_APRILTAG_36h11, refinement, found, ids);
  Corners corners;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    std::array<Vec2, 4> pixel;
    for (std::size_t k = 0; k < 4; ++k) pixel[k] = {found[i][k].x, found[i][k].y};
    corners.emplace_back(ids[i], pixel);
  }
  return corners;
}

struct Sums {
  double squares = 0;
  int poses = 0;
  void add(const SeenRig& seen, const Pose& known) {
    if (seen.verdict != RigVerdict::seen) return;
    squares += (seen.camera_from_probe * test::kTip - known * test::kTip).squaredNorm();
    ++poses;
  }
  double rms() const { return std::sqrt(squares / poses); }
};

void compare(const Camera& camera, int frames) {
  const test::RenderedRig rig(camera, "apriltag_36h11");
  const AprilTag april(2);
  std::mt19937 random(11);
  Sums ours, aprils, arucos;
  std::vector<GreyFrame> images;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(frames); ++i) {
    const Pose known = test::somePose(random);
    images.push_back(rig.renderer.render({known}, {}, i));
    const auto by = [&](const Corners& corners) {
      return poseOf(seenOf(corners, camera), rig.markers, camera);
    };
    const SeenRig a = by(april.find(images.back())),
                  s = by(findByAruco(images.back(), cv::aruco::CORNER_REFINE_SUBPIX)),
                  o = rig.track(images.back());
    EXPECT_EQ(o.verdict, RigVerdict::seen) << i;
    // Only frames in which all have a pose count; misses of the others are not judged here.
    if (a.verdict != RigVerdict::seen || s.verdict != RigVerdict::seen) continue;
    ours.add(o, known), aprils.add(a, known), arucos.add(s, known);
  }
  ASSERT_GT(ours.poses, frames / 2);
  cv::setNumThreads(1);
  const auto least =
      test::minSeconds({[&] { (void)rig.track(images[0]); }, [&] { (void)april.find(images[0]); },
                        [&] { (void)findByAruco(images[0], cv::aruco::CORNER_REFINE_SUBPIX); }},
                       4, 6);
  std::printf(
      "%d x %d, %d of %d frames: tip rms %.4f mm, AprilTag %.4f, SUBPIX %.4f; %.2f ms, %.2f, "
      "%.2f\n",
      camera.width, camera.height, ours.poses, frames, 1e3 * ours.rms(), 1e3 * aprils.rms(),
      1e3 * arucos.rms(), 1e3 * least[0], 1e3 * least[1], 1e3 * least[2]);
  EXPECT_LE(ours.rms(), 2. / 3 * aprils.rms());
  EXPECT_LE(ours.rms(), 0.1 * arucos.rms());
  EXPECT_TRUE(test::within("frame, of AprilTag's (decimate 2)", least[0], least[1], 0.6));
}

TEST(MarkerPeers, TipIsNearerAndSoonerThanTheirsAtVga) {
  compare(test::smallCamera(), 40);
}

TEST(MarkerPeers, TipIsNearerAndSoonerThanTheirsAt1080p) {
  compare(test::largeCamera(), 12);
}

TEST(MarkerPeers, PhotographShowsNoFewerThanAprilTagFinds) {
  const auto path = test::sharedData("markers/apriltag_34139872896_defdb2f8d9_c.jpg");
  PATINA_SKIP_WITHOUT(path);
  const GreyFrame image = readGrey(path);
  const std::vector<CodeBook> books{CodeBook(markerFamily("apriltag_36h11"))};
  const std::size_t quick = findMarkers(image, books, nullptr).size(),
                    thorough = findMarkers(image, books, nullptr, {true}).size();
  const std::size_t half = AprilTag(2).find(image).size(), whole = AprilTag(1).find(image).size();
  std::printf("found %zu, thorough %zu; AprilTag %zu, decimate 1 %zu\n", quick, thorough, half,
              whole);
  EXPECT_GE(quick, half);
  EXPECT_GE(thorough, whole);
}

// Distance of corners from the best image of their plane [px].
double planarResidual(const std::vector<Vec2>& board, const std::vector<Vec2>& pixel) {
  std::vector<cv::Point2d> from, to, moved;
  for (std::size_t i = 0; i < board.size(); ++i) {
    from.emplace_back(board[i].x(), board[i].y());
    to.emplace_back(pixel[i].x(), pixel[i].y());
  }
  cv::perspectiveTransform(from, moved, cv::findHomography(from, to));
  double sum = 0;
  for (std::size_t i = 0; i < to.size(); ++i)
    sum += (moved[i] - to[i]).ddot(moved[i] - to[i]) / static_cast<double>(to.size());
  return std::sqrt(sum);
}

TEST(MarkerPeers, MarkersOfTheSharedBoardLieOnAPlane) {
  const auto path = test::sharedData("markers/choriginal.jpg");
  PATINA_SKIP_WITHOUT(path);
  const Camera camera = readCamera(test::sharedData("markers/tutorial_camera_charuco.yml"));
  const GreyFrame image = readGrey(path);
  const auto cornerOn = [](int id, std::size_t corner) { // squares are 2 wide, markers 1
    int next = 0;
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 5; ++x)
        if ((x + y) % 2 && next++ == id)
          return Vec2(2 * x + 0.5 + (corner == 1 || corner == 2), 2 * y + 0.5 + (corner > 1));
    return Vec2(NAN, NAN);
  };
  std::vector<Vec2> board, ours, theirs_board, theirs;
  for (const SeenMarker& marker : findMarkers(image, {CodeBook(markerFamily("6x6_250"))}, &camera))
    for (std::size_t i = 0; i < 4; ++i) {
      board.push_back(cornerOn(marker.id, i));
      ours.push_back(marker.corner[i].undistorted);
    }
  const cv::Mat view(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.row(0)));
  std::vector<std::vector<cv::Point2f>> found;
  std::vector<int> ids;
  findAruco(view, cv::aruco::DICT_6X6_250, cv::aruco::CORNER_REFINE_SUBPIX, found, ids);
  for (std::size_t m = 0; m < ids.size(); ++m)
    for (std::size_t i = 0; i < 4; ++i) {
      theirs_board.push_back(cornerOn(ids[m], i));
      theirs.push_back(undistortedPoint(camera, Vec2(found[m][i].x, found[m][i].y)).value());
    }
  const double own = planarResidual(board, ours), subpix = planarResidual(theirs_board, theirs);
  std::printf("planar residual %.3f px of %zu corners, SUBPIX %.3f of %zu\n", own, ours.size(),
              subpix, theirs.size());
  EXPECT_GE(ours.size(), theirs.size());
  EXPECT_LE(own, 0.3 * subpix);
}

} // namespace
} // namespace patina
