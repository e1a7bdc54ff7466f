// Commands make a touchable texture from heights.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/file.h"
#include "core/numbers.h"
#include "integration/program.h"
#include "pictures/picture_file.h"
#include "support/profilometer_files.h"
#include "workspace/texture_file.h"

namespace patina::test {
namespace {

class FittedTextures : public testing::Test {
 protected:
  void SetUp() override {
    profile = folder / "profile.csv";
    out = folder / "t.json";
    std::string text = "along [m],height [m]\n";
    for (int i = 0; i <= 500; ++i) {
      const double x = 1e-4 * i;
      text += std::to_string(x) + "," +
              std::to_string(1e-2 + 1e-4 * std::cos(2 * std::numbers::pi * x / 5e-3)) + "\n";
    }
    writeFileAtomically(profile, text);
  }
  ScratchFolder folder;
  std::string profile, out;
};

TEST_F(FittedTextures, HaveTheProfilesLengthAndWave) {
  const Json report =
      runJson({"fit-texture", profile, "-o", out, "--stiffness", "2000", "--name", "waves"});
  EXPECT_NEAR(report.at("length").asNumber(), 0.05, 1e-9);
  EXPECT_NEAR(report.at("wavelength").asNumber(), 5e-3, 1e-9);
  EXPECT_GT(report.at("variance_explained").asNumber(), 0.999);
  const FourierTexture texture = readTexture(out);
  EXPECT_EQ(texture.name, "waves");
  EXPECT_EQ(texture.kind, TextureKind::line);
  EXPECT_DOUBLE_EQ(*texture.compliance, 1. / 2000);
  EXPECT_NEAR(texture.series.a[9], 1e-4, 2e-6);
  for (const char* kind : {"spectrum", "crossed"}) {
    EXPECT_EQ(run({"fit-texture", profile, "-o", out, "--kind", kind}).exit, 0);
    EXPECT_NEAR(rmsHeight(readTexture(out)), rmsHeight(texture), 1e-9);
  }
}

TEST_F(FittedTextures, ComeFromAPictureOfHeights) {
  Picture picture{32, 32, 1, {}};
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      picture.texel.push_back(
          static_cast<float>(0.5 + 0.4 * std::cos(2 * std::numbers::pi * (3 * x + 2 * y) / 32)));
  const std::string file = folder / "waves.exr";
  writePicture(file, picture);
  const auto fit = [&](const std::string& kind) {
    return runJson({"fit-texture", file, "-o", out, "--kind", kind, "--length", "20mm", "--height",
                    "0.1mm", "--harmonics", "8"});
  };
  for (const char* kind : {"plane", "products"}) {
    const Json report = fit(kind);
    EXPECT_NEAR(report.at("length").asNumber(), 0.02, 1e-12);
    EXPECT_LT(report.at("residual").asNumber(), 1e-10);
    const FourierTexture texture = readTexture(out);
    // cos(3 x + 2 y) is two products.
    EXPECT_EQ(texture.products.size(), texture.kind == TextureKind::products ? 2U : 0U);
    EXPECT_NEAR(height(texture, 1e-3, 2e-3),
                0.04e-3 * std::cos(2 * std::numbers::pi * (3 * 1e-3 + 2 * 2e-3) / 0.02), 1e-10);
  }
  expectOneLineError(run({"fit-texture", file, "-o", out, "--kind", "plane"}), {"--length"});
  expectOneLineError(run({"fit-texture", profile, "-o", out, "--rank", "2"}), {"--rank"});
}

// The same wave as an X3P profile, an SDF profile and a table of x and z.
TEST_F(FittedTextures, ComeFromProfilesOfAProfilometer) {
  std::vector<double> heights;
  std::vector<std::string> inline_heights;
  std::string table = "x [mm];z [um]\n", text;
  for (int i = 0; i <= 500; ++i) {
    heights.push_back(std::round(1e5 * std::cos(2 * std::numbers::pi * i / 50)));
    inline_heights.push_back(std::to_string(heights.back()));
    text += inline_heights.back() + "\n";
    table += std::to_string(0.1 * i) + ";" + std::to_string(1e-3 * heights.back()) + "\n";
  }
  X3pFile x3p;
  x3p.feature = "PRF";
  x3p.x = "<AxisType>I</AxisType><Increment>1e-4</Increment>";
  x3p.z = "<AxisType>A</AxisType><DataType>L</DataType><Increment>1e-9</Increment>";
  x3p.size = X3pFile::matrix(501, 1);
  x3p.setInline(inline_heights);
  SdfFile sdf;
  sdf.points = 501;
  sdf.x_scale = 1e-4;
  for (const std::string& bytes :
       {x3p.bytes(), sdf.text(text), sdf.binary(bytesOf<double>(heights)), table}) {
    writeFileAtomically(profile, bytes);
    const Json report = runJson({"fit-texture", profile, "-o", out});
    EXPECT_NEAR(report.at("length").asNumber(), 0.05, 1e-9);
    EXPECT_NEAR(report.at("wavelength").asNumber(), 5e-3, 1e-9);
    EXPECT_NEAR(readTexture(out).series.a[9], 1e-4, 2e-6);
  }
  expectOneLineError(run({"fit-texture", profile, "-o", out, "--kind", "plane"}),
                     {"profile.csv", "is a profile"});
  writeFileAtomically(profile, "x [mm],z\n0,1\n");
  expectOneLineError(run({"fit-texture", profile, "-o", out}), {"profile.csv:1", "has no unit"});
}

TEST_F(FittedTextures, ComeFromAnAreaOfAProfilometer) {
  X3pFile area;
  area.x = area.y = "<AxisType>I</AxisType><Increment>1e-4</Increment>";
  area.size = X3pFile::matrix(121, 101);
  std::vector<double> heights;
  for (int i = 0; i < 121 * 101; ++i)
    heights.push_back(1e-5 * (i % 121) + 1e-5 * std::cos(2 * std::numbers::pi * (i % 121) / 20));
  heights[5000] = std::nan("");
  area.setBinary(bytesOf<double>(heights));
  const std::string file = folder / "leather.x3p";
  writeFileAtomically(file, area.bytes());
  for (const char* kind : {"plane", "products"}) {
    const Outcome done = run({"fit-texture", file, "-o", out, "--kind", kind});
    EXPECT_EQ(done.exit, 0);
    EXPECT_NE(done.err.find("1 of 12,221 points were not measured"), std::string::npos);
    EXPECT_NE(done.err.find("the square of 101 in the middle is fitted"), std::string::npos);
    EXPECT_NEAR(period(readTexture(out)), 0.01, 1e-9);
    EXPECT_NEAR(rmsHeight(readTexture(out)), 1e-5 / std::numbers::sqrt2, 3e-7);
  }
  expectOneLineError(run({"fit-texture", file, "-o", out}), {"leather.x3p", "is an area"});
  area.files["bindata/data.bin"][9] ^= 1;
  writeFileAtomically(file, area.bytes());
  expectOneLineError(run({"fit-texture", file, "-o", out, "--kind", "plane"}),
                     {"leather.x3p", "checksum"});
}

// Waves of 20 mm are left out, so that the texture has only the variance of those of 2 mm.
TEST_F(FittedTextures, SayHowMuchOfTheHeightsTheyHave) {
  constexpr double kLong = 1e-4, kShort = 2e-5; // amplitudes [m]
  std::string table = "along [m],height [m]\n";
  for (int i = 0; i <= 1000; ++i) {
    const double x = 1e-4 * i;
    table += formatNumber(x) + "," +
             formatNumber(kLong * std::sin(2 * std::numbers::pi * x / 0.02) +
                          kShort * std::sin(2 * std::numbers::pi * x / 0.002)) +
             "\n";
  }
  const std::string waves = folder / "waves.csv";
  writeFileAtomically(waves, table);
  const Json report = runJson({"fit-texture", waves, "-o", out, "--cutoff", "8mm"});
  EXPECT_NEAR(report.at("variance_explained").asNumber(),
              kShort * kShort / (kLong * kLong + kShort * kShort), 2e-3);
  EXPECT_NEAR(report.at("left_out").asNumber(), kLong / std::numbers::sqrt2, 1e-6);
}

TEST_F(FittedTextures, ComeFromAScansHeights) {
  const std::string plate = folder / "plate.ply", scan = folder / "scan",
                    heights = folder / "heights.csv";
  ASSERT_EQ(run({"model", "box", "-o", plate}).exit, 0);
  ASSERT_EQ(run({"simulate-scan", plate, "-o", scan, "--roughness", "0.05mm"}).exit, 0);
  ASSERT_EQ(run({"filter", scan, "-o", folder / "path.csv", "--heights", heights}).exit, 0);
  const Json report = runJson({"fit-texture", heights, "-o", out});
  EXPECT_GT(report.at("length").asNumber(), 0.01);
  EXPECT_GT(report.at("rms").asNumber(), 0.02e-3);
  EXPECT_LT(report.at("rms").asNumber(), 0.2e-3);
  EXPECT_EQ(problemOf(readTexture(out)), "");
}

TEST_F(FittedTextures, AreRefusedWithTheNameOfTheWrongFile) {
  const std::string bad = folder / "bad.csv";
  expectOneLineError(run({"fit-texture", folder / "none.csv", "-o", out}), {"none.csv"});
  writeFileAtomically(bad, "along [m],height [m]\n0,0\n1e-3,1,7\n");
  expectOneLineError(run({"fit-texture", bad, "-o", out}), {"bad.csv:3"});
  writeFileAtomically(bad, "along [m],height [m]\n0,0\n1e-3,nan\n2e-3,0\n3e-3,0\n");
  expectOneLineError(run({"fit-texture", bad, "-o", out}), {"bad.csv"});
  writeFileAtomically(bad, "along [m],height [m]\n0,0\n1e-3,0\n2e-3,0\n3e-3,0\n5e-3,0\n");
  expectOneLineError(run({"fit-texture", bad, "-o", out}), {"bad.csv"});
  writeFileAtomically(bad, "t [s],along [m],height [m]\n0,0,0\n1,1e-3,x\n");
  expectOneLineError(run({"fit-texture", bad, "-o", out}), {"bad.csv:3", "x"});
  writeFileAtomically(bad, "along [m],height [m]\n0,0\n0.2,0\n0.1,0\n0.3,0\n");
  expectOneLineError(run({"fit-texture", bad, "-o", out}), {"bad.csv:4", "runs backwards"});
  expectOneLineError(run({"fit-texture", profile, "-o", out, "--step", "0.00001mm"}),
                     {"profile.csv", "longer step"});
  expectOneLineError(run({"fit-texture", profile, "-o", profile}), {"profile.csv"});
  expectOneLineError(run({"fit-texture", profile, "-o", out, "--kind", "cloud"}), {"cloud"});
  expectOneLineError(run({"fit-texture", profile, "-o", out, "--interval", "4"}), {"stretch 4"});
  EXPECT_FALSE(std::filesystem::exists(out));
}

} // namespace
} // namespace patina::test
