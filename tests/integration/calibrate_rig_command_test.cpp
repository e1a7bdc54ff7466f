// `patina calibrate` finds a rig that was made by hand from rendered frames; `patina track` and
// `patina filter` say that it is not as its file says.
#include <cmath>

#include <Eigen/Geometry>

#include "acquisition/files/frame_files.h"
#include "acquisition/files/scan_tables.h"
#include "core/file.h"
#include "integration/scans.h"

namespace patina::test {
namespace {

// The tip in the frame of the first marker, whatever the frame of the rig.
Vec3 tipBesideMarker(const std::string& text) {
  return parseMarkers(text, "rig")[0].probe_from_marker.inverse() * parseRig(text, "rig").probe.tip;
}

TEST_F(Scans, CalibrateFindsARigMadeByHandAndTrackSaysSo) {
  (void)simulate({"--waved", "--seconds", "20", "--glue", "0.3mm", "--glue-angle", "0.5",
                  "--print-scale", "1.01", "--seed", "4"});
  const std::string truth = scan + "/truth.json", rig = folder / "rig.json";
  const std::string real = parseJson(readFile(truth), truth).at("rig").dump();
  const std::vector<RigMarker> markers = parseMarkers(real, truth);
  const std::string length = "0=" + std::to_string(markers[0].size);
  const Json report = runJson({"calibrate", scan, "--length", length, "-o", rig});
  EXPECT_LT(report.at("rms_px").asNumber(), 0.1);
  EXPECT_GT(report.at("rms_before_px").asNumber(), 3 * report.at("rms_px").asNumber());
  EXPECT_NEAR(report.at("parameters").at("print_scale").at("value").asNumber(), 1.01, 1e-3);
  EXPECT_EQ(report.at("markers").asArray().size(), markers.size());
  EXPECT_TRUE(report.at("held").asArray().empty());

  const std::string text = readFile(rig);
  const std::vector<RigMarker> found = parseMarkers(text, rig);
  for (std::size_t i = 0; i < markers.size(); ++i)
    EXPECT_NEAR(found[i].size / markers[i].size, 1, 1e-3);
  EXPECT_LT((tipBesideMarker(text) - tipBesideMarker(real)).norm(), 0.15e-3);
  EXPECT_GT(parseJson(text, rig).at("markers").asArray()[0].at("size_deviation").asNumber(), 0);
  EXPECT_NE(parseJson(text, rig).find("accelerometers"), nullptr) << "the rest of the rig stays";

  const std::string poses = scan + "/poses.tum";
  const Outcome doubted = run({"track", scan, "-o", poses});
  EXPECT_EQ(doubted.exit, 0);
  EXPECT_NE(doubted.err.find("calibrate the rig"), std::string::npos) << doubted.err;
  const Outcome filtered = run({"filter", scan, "-o", path});
  EXPECT_NE(filtered.err.find("calibrate the rig"), std::string::npos) << filtered.err;
  // The deviations cover the error of the tip: that of the mean over the path, too.
  const Json wrong = runJson({"filter", scan, "-o", path});
  EXPECT_LT(wrong.at("error").at("nees").asNumber(), 3);
  EXPECT_EQ(run({"track", scan, "--rig", rig, "-o", poses}).err, "");

  // A measured marker that the rig has not, a camera of another size, a rig with a marker twice.
  const std::string none = folder / "none.json";
  expectOneLineError(run({"calibrate", scan, "--length", "9=27mm", "-o", none}),
                     {"the rig has no marker 9"});
  expectOneLineError(run({"calibrate", scan, "--length", "27mm", "-o", none}),
                     {"--length", "ID=SIZE"});
  std::string twice = text;
  twice.replace(twice.find("\"id\": 1"), 7, "\"id\": 0");
  const std::string doubled = folder.write("twice.json", twice);
  expectOneLineError(run({"calibrate", scan, "--rig", doubled, "-o", none}),
                     {"twice.json", "marker 0 is there twice"});
  std::string other = twice;
  const std::string family = "4x4_50";
  for (std::size_t at = text.find(family); at != std::string::npos; at = other.find(family, at + 1))
    other.replace(at, family.size(), "7x7_50");
  other.replace(other.find("\"id\": 0", other.find("\"id\": 0") + 1), 7, "\"id\": 1");
  expectOneLineError(
      run({"calibrate", scan, "--rig", folder.write("other.json", other), "-o", none}),
      {scan, "shows a marker of the rig", "families and ids"});
  GreyFrame small = readGrey(scan + "/frames/000100.png");
  small.width /= 2, small.height /= 2;
  small.pixel.resize(static_cast<std::size_t>(small.width) *
                     static_cast<std::size_t>(small.height));
  writeGrey(scan + "/frames/000100.png", small);
  expectOneLineError(run({"calibrate", scan, "-o", none}), {"000100.png", "320 x 240"});
  EXPECT_FALSE(std::filesystem::exists(none));
}

} // namespace
} // namespace patina::test
