// Calibrations as OpenCV, ROS and kalibr write them.
#include "acquisition/files/camera_file.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "support/rendered_rig.h"

namespace patina {
namespace {

std::string cameraRefusal(const std::string& text) {
  try {
    parseCamera(text, "cam");
  } catch (const FileError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "taken";
}

bool isSameCamera(const Camera& a, const Camera& b) {
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
         a.cx == b.cx && a.cy == b.cy && a.distortion == b.distortion && a.lens == b.lens;
}

std::string rosCamera(const std::string& model, const std::string& coefficients) {
  return "image_width: 640\nimage_height: 480\ncamera_name: cam\ncamera_matrix:\n  rows: 3\n"
         "  cols: 3\n  data: [340.0, 0.0, 320.0, 0.0, 341.0, 240.0, 0.0, 0.0, 1.0]\n" +
         (model.empty() ? "" : "distortion_model: " + model + "\n") +
         "distortion_coefficients:\n  rows: 1\n  cols: 0\n  data: [" + coefficients +
         "]\nrectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
         "projection_matrix:\n  rows: 3\n  cols: 4\n"
         "  data: [340, 0, 320, 0, 0, 341, 240, 0, 0, 0, 1, 0]\n";
}

Camera cameraWith(LensModel lens, const std::array<double, 14>& distortion) {
  Camera camera{640, 480, 340, 341, 320, 240, distortion};
  camera.lens = lens;
  return camera;
}

const std::array<double, 14> kFour = {-0.05, 0.01, 1e-3, -2e-3};
const Camera kBrown = cameraWith(LensModel::brown, kFour),
             kFisheye = cameraWith(LensModel::fisheye, kFour);
constexpr const char* kFourText = "-0.05, 0.01, 1e-3, -2.0e-3";

TEST(CameraFile, ReadsBackEveryLensBitForBit) {
  for (const Camera& camera :
       {test::smallCamera(), test::rationalCamera(), test::tiltedCamera(), test::fisheyeCamera(),
        Camera{640, 480, 600. / 7, 602, 322.1, 238, {-0.08, 0.03, 3e-4, -2e-4, 1. / 3}},
        Camera{640, 480, 600, 600, 320, 240, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1e-3}},
        Camera{640, 480, 600, 600, 320, 240, {}}})
    EXPECT_TRUE(isSameCamera(parseCamera(cameraText(camera, "rms: 0.2\n"), "cam"), camera))
        << cameraText(camera);
}

TEST(CameraFile, ReadsYamlFromOpenCv) {
  const Camera camera = parseCamera(
      "%YAML:1.0\n---\ncalibration_time: \"Wed 08 Dec\"\nimage_width: 640\nimage_height: 480\n"
      "flags: 0\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
      "   data: [ 4.5e+02, 0., 3.1e+02, 0.,\n       4.6e+02, 2.7e+02, 0., 0., 1. ]\n"
      "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n"
      "   data: [ 1.2e-01, -1.0, 1e-04,\n       -4e-04,\n       2.9 ]\ninfo: \"none\"\n",
      "cam");
  EXPECT_EQ(camera.fx, 450);
  EXPECT_EQ(camera.cy, 270);
  EXPECT_EQ(camera.distortion[1], -1);
  EXPECT_EQ(camera.distortion[4], 2.9);
}

TEST(CameraFile, ReadsTheModelThatTheFileNames) {
  for (const char* model : {"", "plumb_bob", "radtan", "Plumb_Bob", "\"plumb_bob\"", "'plumb_bob'",
                            "plumb_bob # Brown", "rational_polynomial"})
    EXPECT_TRUE(isSameCamera(parseCamera(rosCamera(model, kFourText), "cam"), kBrown)) << model;
  for (const char* model : {"equidistant", "fisheye", "EQUIDISTANT", "kannala_brandt4"})
    EXPECT_TRUE(isSameCamera(parseCamera(rosCamera(model, kFourText), "cam"), kFisheye)) << model;
  for (const char* zeros : {", 0", ", 0, 0.0, 0, 0"}) {
    EXPECT_TRUE(isSameCamera(
        parseCamera(rosCamera("plumb_bob", kFourText + std::string(zeros)), "cam"), kBrown));
    EXPECT_TRUE(isSameCamera(
        parseCamera(rosCamera("equidistant", kFourText + std::string(zeros)), "cam"), kFisheye));
  }
  EXPECT_EQ(parseCamera(rosCamera("none", ""), "cam").distortion, (std::array<double, 14>{}));
  EXPECT_EQ(parseCamera(rosCamera("plumb_bob", "0.1"), "cam").distortion[0], 0.1);
  std::string list;
  for (std::size_t count = 1; count <= 14; ++count) {
    list += (count > 1 ? ", " : "") + std::string("0.0") + std::to_string(count);
    if (count != 5 && count != 8 && count != 12 && count != 14) continue;
    for (const char* model : {"", "plumb_bob", "rational_polynomial"}) {
      const Camera camera = parseCamera(rosCamera(model, list), "cam");
      EXPECT_EQ(camera.distortion[count - 1], std::stod("0.0" + std::to_string(count)));
      EXPECT_EQ(camera.lens, LensModel::brown);
    }
  }
  EXPECT_TRUE(
      isSameCamera(parseCamera("fisheye_model: 1\n" + rosCamera("", kFourText), "cam"), kFisheye));
  EXPECT_TRUE(
      isSameCamera(parseCamera("fisheye_model: 0\n" + rosCamera("", kFourText), "cam"), kBrown));
}

TEST(CameraFile, ReadsTheFormatOfEachProgram) {
  const std::string matrix = "340. 0. 320. 0. 341.\n 240. 0. 0. 1.",
                    four = "-5e-2 1e-2 1e-3\n -2e-3";
  const auto xml = [&](const std::string& more) {
    return "<?xml version=\"1.0\"?>\n<!-- a <comment> -->\n<opencv_storage>\n"
           "<calibration_time>\"Wed 08\"</calibration_time>\n<image_width>640</image_width>\n"
           "<image_height>480</image_height>\n" +
           more +
           "<camera_matrix type_id=\"opencv-matrix\">\n  <rows>3</rows><cols>3</cols><dt>d</dt>\n"
           "  <data>\n    " +
           matrix +
           "</data></camera_matrix>\n<empty/>\n"
           "<distortion_coefficients type_id=\"opencv-matrix\"><rows>4</rows><cols>1</cols>\n"
           "<dt>d</dt><data>" +
           four + "</data></distortion_coefficients>\n</opencv_storage>\n";
  };
  EXPECT_TRUE(isSameCamera(parseCamera(xml(""), "cam"), kBrown));
  EXPECT_TRUE(isSameCamera(parseCamera(xml("<fisheye_model>1</fisheye_model>"), "cam"), kFisheye));
  const auto kalibr = [](const std::string& model) {
    return "cam0:\n  cam_overlaps: []\n  camera_model: pinhole\n"
           "  distortion_coeffs: [-0.05, 0.01,\n    1.0e-3, -2.0e-3]\n  distortion_model: " +
           model +
           "\n  intrinsics: [340.0, 341.0, 320, 240]\n  resolution: [640, 480]\n"
           "  rostopic: /cam0/image_raw\n";
  };
  EXPECT_TRUE(isSameCamera(parseCamera(kalibr("radtan"), "cam"), kBrown));
  EXPECT_TRUE(isSameCamera(parseCamera(kalibr("equidistant"), "cam"), kFisheye));
  // `ros2 topic echo /camera_info --once` and ROS 1's rostopic.
  EXPECT_TRUE(
      isSameCamera(parseCamera("header:\n  stamp:\n    sec: 1\n  frame_id: cam\nheight: 480\n"
                               "width: 640\ndistortion_model: equidistant\nd:\n- -0.05\n- 0.01\n"
                               "- 0.001\n- -0.002\nk:\n- 340.0\n- 0.0\n- 320.0\n- 0.0\n- 341.0\n"
                               "- 240.0\n- 0.0\n- 0.0\n- 1.0\nr:\n- 1.0\nroi:\n  height: 0\n"
                               "  width: 0\n---\n",
                               "cam"),
                   kFisheye));
  EXPECT_TRUE(isSameCamera(parseCamera("height: 480\nwidth: 640\ndistortion_model: \"plumb_bob\"\n"
                                       "D: [-0.05, 0.01, 0.001, -0.002]\n"
                                       "K: [340.0, 0.0, 320.0, 0.0, 341.0, 240.0, 0.0, 0.0, 1.0]\n",
                                       "cam"),
                           kBrown));
  // OpenCV's JSON, a matrix by rows, CR line ends, a byte order mark.
  EXPECT_TRUE(isSameCamera(
      parseCamera("{\n  \"image_width\": 640, \"image_height\": 480,\n"
                  "  \"camera_matrix\": {\"type_id\": \"opencv-matrix\", \"rows\": 3,\n"
                  "    \"data\": [340.0, 0, 320, 0, 341, 240, 0, 0, 1]},\n"
                  "  \"distortion_coefficients\": {\"data\": [-0.05, 0.01, 0.001, "
                  "-0.002]}\n}\n",
                  "cam"),
      kBrown));
  EXPECT_TRUE(isSameCamera(parseCamera("image_width: 640\nimage_height: 480\ncamera_matrix:\n"
                                       "- - 340\n  - 0\n  - 320\n- [0, 341, 240]\n- [0, 0, 1]\n"
                                       "dist_coeffs: [[-0.05, 0.01, 0.001, -0.002]]\n",
                                       "cam"),
                           kBrown));
  std::string mac = "\xEF\xBB\xBF" + rosCamera("equidistant", kFourText);
  for (char& c : mac) c = c == '\n' ? '\r' : c;
  EXPECT_TRUE(isSameCamera(parseCamera(mac, "cam"), kFisheye));
}

TEST(CameraFile, RejectsInvalidFilesInOneLine) {
  const std::string good = cameraText({640, 480, 600, 600, 320, 240, {}});
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(cameraRefusal(good), "taken");
  EXPECT_EQ(cameraRefusal("nothing\n"), "cam: 'image_width' is missing");
  EXPECT_EQ(cameraRefusal(with("640", "6.5")),
            "cam:3: 'image_width' must be a whole number up to 16384");
  EXPECT_EQ(cameraRefusal(with("600, 0, 320", "600, x, 320")), "cam:9: 'x' is not a finite number");
  EXPECT_EQ(cameraRefusal(with("600, 0, 320", "600, .nan, 320")),
            "cam:9: '.nan' is not a finite number");
  EXPECT_EQ(cameraRefusal(with("600, 0, 320", "-600, 0, 320")),
            "cam:9: 'camera_matrix' must be fx 0 cx 0 fy cy 0 0 1");
  EXPECT_EQ(cameraRefusal(with("600, 0, 320, ", "600, ")),
            "cam:9: 'camera_matrix' has 7 numbers for 3 x 3");
  EXPECT_EQ(cameraRefusal(good + "image_width: 640\n"),
            "cam:15: 'image_width' stands in line 3 already");
  EXPECT_EQ(cameraRefusal(with("320, 0, 600", "320, 0, [600")),
            "cam:9: has a bracket that never closes");
}

TEST(CameraFile, RejectionNamesTheModelAndTheKnownModels) {
  const std::string known = "; known are plumb_bob, radtan, rational_polynomial, thin_prism, "
                            "tilted, none, equidistant, fisheye, kannala_brandt, kannala_brandt4";
  EXPECT_EQ(cameraRefusal(rosCamera("fov", "0.9")), "cam:8: 'distortion_model' is 'fov'" + known);
  EXPECT_EQ(cameraRefusal(rosCamera("inverse_brown_conrady", "0, 0, 0, 0, 0")),
            "cam:8: 'distortion_model' is 'inverse_brown_conrady'" + known);
  std::string five = rosCamera("plumb_bob", "0.1, 0.2, 0.3, 0.4, 0.5");
  five.replace(five.find("cols: 0"), 7, "cols: 4");
  EXPECT_EQ(cameraRefusal(five), "cam:12: 'distortion_coefficients' has 5 numbers for 1 x 4");
  EXPECT_EQ(cameraRefusal(rosCamera("equidistant", "0.1, 0.2, 0.3, 0.4, 0.5")),
            "cam:12: 'distortion_coefficients' of 'equidistant' has 5 numbers; known are 4");
  EXPECT_EQ(cameraRefusal(rosCamera("equidistant", "0.1, 0.2")),
            "cam:12: 'distortion_coefficients' of 'equidistant' has 2 numbers; known are 4");
  EXPECT_EQ(cameraRefusal(rosCamera("plumb_bob", "1, 1, 1, 1, 1, 1")),
            "cam:12: 'distortion_coefficients' of 'plumb_bob' has 6 numbers; known are 4, 5, 8, 12 "
            "and 14");
  EXPECT_EQ(cameraRefusal(rosCamera("", "1, 1, 1, 1, 1, 1, 1, 1, 1")),
            "cam:11: 'distortion_coefficients' has 9 numbers; known are 4, 5, 8, 12 and 14");
  EXPECT_EQ(cameraRefusal(rosCamera("radtan", "1, 1, 1, 1, 1")),
            "cam:12: 'distortion_coefficients' of 'radtan' has 5 numbers; known are 4");
  EXPECT_EQ(cameraRefusal(rosCamera("none", "0.1")),
            "cam:12: 'distortion_coefficients' of 'none' has 1 numbers; known are none");
  EXPECT_EQ(cameraRefusal("fisheye_model: 1\n" + rosCamera("plumb_bob", kFourText)),
            "cam:1: 'fisheye_model' is 1, but 'distortion_model' is 'plumb_bob'");
  EXPECT_EQ(cameraRefusal("fisheye_model: 2\n" + rosCamera("", kFourText)),
            "cam:1: 'fisheye_model' is '2'; known are 0 and 1");
  const std::string omni = "cam0:\n  camera_model: omni\n  distortion_coeffs: [0, 0, 0, 0]\n"
                           "  distortion_model: radtan\n  intrinsics: [1.9, 340, 340, 320, 240]\n"
                           "  resolution: [640, 480]\n";
  EXPECT_EQ(cameraRefusal(omni), "cam:2: 'camera_model' is 'omni'; only pinhole is known");
  const std::string two = "cam0:\n  intrinsics: [1, 1, 1, 1]\ncam1:\n  intrinsics: [1, 1, 1, 1]\n";
  EXPECT_EQ(cameraRefusal(two),
            "cam:4: there are several cameras, cam0 and cam1: keep one of them in the "
            "file");
}

} // namespace
} // namespace patina
