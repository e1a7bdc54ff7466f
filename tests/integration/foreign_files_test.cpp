// Tables and calibrations from other programs, through the commands that read them.
#include <algorithm>
#include <sstream>

#include "core/csv.h"
#include "integration/scans.h"

namespace patina::test {
namespace {

std::string withEach(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

// Written by a spreadsheet with decimal commas.
std::string german(const std::string& text) {
  return "\xEF\xBB\xBF" + withEach(withEach(withEach(text, ",", ";"), ".", ","), "\n", "\r\n");
}

class ForeignTables : public Scans {};

TEST_F(ForeignTables, GiveTheSameSamplesAsPlainTables) {
  std::string plain = "t [s],x [m],y [m],z [m]\n", scaled = "note;z [mm];t [ms];x [um];y [cm]\n";
  for (int i = 0; i < 50; ++i) {
    const int height = 60 - i; // [mm]
    plain += "0." + std::string(i < 10 ? "0" : "") + std::to_string(i) + ",0.001,0.002,0.0" +
             std::to_string(height) + "\n";
    scaled += "a,b;" + std::to_string(height) + ";" + std::to_string(10 * i) + ";1000;0,2\n";
  }
  const std::string twin = folder.write("plain.csv", plain);
  const std::string others[] = {
      folder.write("quoted.csv", withEach(plain, "t [s],x [m],y [m],z [m]",
                                          "\"t [s]\",\"x [m]\",\"y [m]\",\"z [m]\"")),
      folder.write("german.csv", german(plain)),
      folder.write("tabs.csv", withEach(plain, ",", "\t")),
      folder.write("mac.csv", withEach(plain, "\n", "\r")), folder.write("scaled.csv", scaled)};
  const std::string out = folder / "out.csv";
  const auto forces = [&](const std::string& tips) {
    const Outcome felt = run({"feel", ball, "--path", tips, "-o", out, "--resolution", "40"});
    EXPECT_EQ(felt.exit, 0) << tips << felt.err;
    EXPECT_EQ(felt.err.find("left out: note") != std::string::npos, tips.ends_with("scaled.csv"))
        << felt.err;
    CsvTable table = readCsv(out, {"t [s]", "fz [N]"});
    const auto step = std::find(table.columns.begin(), table.columns.end(), "step [ns]");
    for (auto& row : table.rows) row[static_cast<std::size_t>(step - table.columns.begin())] = 0;
    return table.rows;
  };
  const auto expected = forces(twin);
  EXPECT_GT(expected.back()[1], 0);
  for (const std::string& other : others) EXPECT_EQ(forces(other), expected) << other;
  const auto samples = [&](const std::string& points) {
    EXPECT_EQ(run({"sample", ball, "--points", points, "-o", out, "--resolution", "40"}).exit, 0);
    return readFile(out);
  };
  const std::string sampled = samples(twin);
  for (const std::string& other : others) EXPECT_EQ(samples(other), sampled) << other;
  // The output of feel is a path that is read without a warning.
  ASSERT_EQ(run({"feel", ball, "--path", twin, "-o", folder / "felt.csv"}).exit, 0);
  EXPECT_EQ(run({"feel", ball, "--path", folder / "felt.csv", "-o", out}).err.find("left out"),
            std::string::npos);
}

TEST_F(ForeignTables, NameTheWrongSeparatorUnitOrColumn) {
  const std::string out = folder / "out.csv";
  const auto refused = [&](const std::string& text, const std::vector<std::string>& parts) {
    expectOneLineError(run({"feel", ball, "--path", folder.write("t.csv", text), "-o", out}),
                       parts);
    EXPECT_FALSE(std::filesystem::exists(out));
  };
  refused("t [s]|x [m]|y [m]|z [m]\n", {"t.csv:1:", "comma, semicolon or tab"});
  refused("t [s];x [ell];y [m];z [m]\n", {"t.csv:1:", "semicolons", "'x [ell]'", "mm"});
  refused("t [s]\tx [m]\ty [m]\n", {"t.csv:1:", "tabs", "'z [m]'"});
  refused("t,x,y,z\n0,0,0,0\n", {"t.csv:1:", "'t' has no unit", "'t [s]'"});
  refused("t [s];x [m];y [m];z [m]\n0;1.234,5;0;0\n", {"t.csv:2:", "x [m]", "'1.234,5'"});
  const Outcome felt = run({"feel", ball, "--path",
                            folder.write("t.csv", "t [s],x [m],y [m],z [m]\n0,0,0,.1\n"
                                                  "1,0,-1.#IND,.1\n2,nan,0,.1\n"),
                            "-o", out});
  EXPECT_EQ(felt.exit, 0);
  EXPECT_NE(felt.err.find("2 tips are NaN or infinite, no force there; line 3: y [m] is '-1.#IND'"),
            std::string::npos)
      << felt.err;
}

TEST_F(ForeignTables, FilterToTheSamePathAsPlainTables) {
  simulate({"--seconds", "3"});
  const std::string heights = folder / "heights.csv", texture = folder / "texture.json";
  ASSERT_EQ(run({"filter", scan, "-o", path, "--heights", heights}).exit, 0);
  const std::string plain = readFile(path);
  const std::string probe = readFile(scan + "/probe.csv");
  writeFileAtomically(scan + "/probe.csv", german(probe));
  ASSERT_EQ(run({"filter", scan, "-o", path}).exit, 0);
  EXPECT_EQ(readFile(path), plain);
  std::string more = withEach(probe, "\n", ",7\n");
  more.replace(more.find(",7\n"), 3, ",battery [V]\n");
  writeFileAtomically(scan + "/probe.csv", more);
  const Outcome filtered = run({"filter", scan, "-o", path});
  EXPECT_EQ(readFile(path), plain);
  EXPECT_NE(filtered.err.find("probe.csv: column left out: battery [V]"), std::string::npos)
      << filtered.err;
  ASSERT_EQ(run({"fit-texture", heights, "-o", texture}).exit, 0);
  const std::string fitted = readFile(texture);
  writeFileAtomically(heights, german(readFile(heights)));
  ASSERT_EQ(run({"fit-texture", heights, "-o", texture}).exit, 0);
  EXPECT_EQ(readFile(texture), fitted);
}

TEST_F(Scans, TrackAFisheyeCameraByEveryProgramsCalibration) {
  const std::string numbers = "340, 0, 320, 0, 340, 240, 0, 0, 1", lens = "-0.05, 0.01, 0, 0";
  const std::string ros = "image_width: 640\nimage_height: 480\ncamera_matrix:\n  rows: 3\n"
                          "  cols: 3\n  data: [" +
                          numbers +
                          "]\ndistortion_model: equidistant\ndistortion_coefficients:\n"
                          "  rows: 1\n  cols: 4\n  data: [" +
                          lens + "]\n";
  const std::string kalibr =
      "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [" + lens +
      "]\n  distortion_model: equidistant\n  intrinsics: [340, 340, 320, 240]"
      "\n  resolution: [640, 480]\n";
  const std::string xml =
      "<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_width>640</image_width>\n"
      "<image_height>480</image_height>\n<fisheye_model>1</fisheye_model>\n<camera_matrix "
      "type_id=\"opencv-matrix\">\n<data>" +
      withEach(numbers, ",", "") + "</data></camera_matrix>\n<distortion_coefficients><data>" +
      withEach(lens, ",", "") + "</data></distortion_coefficients>\n</opencv_storage>\n";
  const std::string camera = folder.write("cam.yaml", ros);
  simulate({"--frames", "--camera", camera, "--seconds", "1"});
  const std::string poses = folder / "poses.tum";
  const Json own = runJson({"track", scan, "-o", poses});
  EXPECT_GE(own.at("frames_with_pose").asInteger(), own.at("frames").asInteger() * 8 / 10);
  EXPECT_LT(own.at("reprojection_rms_px").asNumber(), 0.1);
  const std::string found = readFile(poses);
  for (const std::string& text : {ros, kalibr, xml}) {
    writeFileAtomically(camera, text);
    ASSERT_EQ(run({"track", scan, "--camera", camera, "-o", poses}).exit, 0);
    EXPECT_EQ(readFile(poses), found);
  }
  writeFileAtomically(camera, withEach(ros, "equidistant", "fov"));
  expectOneLineError(run({"track", scan, "--camera", camera, "-o", poses}),
                     {"cam.yaml:7:", "'fov'", "equidistant", "plumb_bob"});
}

} // namespace
} // namespace patina::test
