#include "acquisition/profilometer/measured_heights.h"

#include <algorithm>
#include <cmath>
#include <minizip/zip.h>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "acquisition/profilometer/square_area.h"
#include "acquisition/texture/fit_plane.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "support/fresh_folder.h"
#include "support/profilometer_files.h"

namespace patina {
namespace {

using test::SdfFile;
using test::X3pFile;
using Lines = std::vector<std::string>;

MeasuredHeights parsed(const std::string& bytes, Lines* warnings = nullptr) {
  Lines own;
  MeasuredHeights measured = parseMeasuredHeights(bytes, "file", warnings ? *warnings : own);
  EXPECT_EQ(own, Lines{});
  return measured;
}
// The one-line message of a rejected file.
std::string refusal(const std::string& bytes) {
  Lines warnings;
  try {
    parseMeasuredHeights(bytes, "file", warnings);
  } catch (const FileError& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_TRUE(line.starts_with("file:")) << line;
    return line;
  }
  return "";
}
void expectRefused(const std::string& bytes, const std::string& cause) {
  const std::string line = refusal(bytes);
  EXPECT_NE(line.find(cause), std::string::npos) << "'" << line << "' lacks '" << cause << "'";
}

// Whole numbers, so that every type holds them: 7 columns and 4 rows, or the first row alone.
constexpr std::size_t kColumns = 7, kRows = 4;
std::vector<double> wholeNumbers(std::size_t rows, double least = -120) {
  std::vector<double> values;
  for (std::size_t i = 0; i < kColumns * rows; ++i)
    values.push_back(least + static_cast<double>((i * 37) % 113));
  return values;
}
Lines allNames(const std::vector<double>& values) {
  Lines texts;
  for (const double value : values) texts.push_back(formatNumber(value));
  return texts;
}
std::string joinedBy(const std::string& between, const Lines& texts) {
  std::string all;
  for (const std::string& text : texts) all += text + between;
  return all;
}
void expectHeights(const MeasuredHeights& measured, const std::vector<double>& values, double unit,
                   double offset = 0) {
  ASSERT_EQ(measured.heights.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(measured.heights[i], offset + unit * values[i], 1e-13) << i;
}

TEST(X3p, HoldsProfilesAndAreasOfEachTypeInlineAndBinary) {
  for (const char type : {'I', 'L', 'F', 'D'})
    for (const std::size_t rows : {std::size_t{1}, kRows})
      for (const bool binary : {false, true}) {
        SCOPED_TRACE(std::string(1, type) + " " + std::to_string(rows) + (binary ? " binary" : ""));
        X3pFile file;
        file.feature = rows == 1 ? "PRF" : "SUR";
        file.size = X3pFile::matrix(kColumns, rows);
        file.z = "<AxisType>A</AxisType><DataType>" + std::string(1, type) +
                 "</DataType><Increment>1.0E-9</Increment><Offset>5e-7</Offset>";
        const std::vector<double> values = wholeNumbers(rows);
        if (binary)
          file.setBinary(test::bytesAs(type, values));
        else
          file.setInline(allNames(values));
        const MeasuredHeights measured = parsed(file.bytes());
        expectHeights(measured, values, 1e-9, 5e-7);
        EXPECT_EQ(measured.columns, kColumns);
        EXPECT_EQ(measured.rows, rows);
        if (rows == 1) {
          for (std::size_t i = 0; i < kColumns; ++i)
            EXPECT_NEAR(measured.along[i], 1e-6 * static_cast<double>(i), 1e-15);
        } else {
          EXPECT_EQ(measured.step_x, 1e-6);
          EXPECT_EQ(measured.step_y, 2e-6);
        }
      }
}

// Other programs write compressed members.
TEST(X3p, IsReadFromACompressedArchive) {
  const auto path = test::freshFolder("x3p") / "leather.X3P";
  X3pFile file;
  file.size = X3pFile::matrix(kColumns, kRows);
  file.setBinary(test::bytesAs('D', wholeNumbers(kRows)));
  zipFile zip = zipOpen(path.c_str(), APPEND_STATUS_CREATE);
  for (const auto& [name, bytes] : file.members()) {
    ASSERT_EQ(zipOpenNewFileInZip(zip, name.c_str(), nullptr, nullptr, 0, nullptr, 0, nullptr,
                                  Z_DEFLATED, Z_BEST_COMPRESSION),
              ZIP_OK);
    zipWriteInFileInZip(zip, bytes.data(), static_cast<unsigned>(bytes.size()));
    zipCloseFileInZip(zip);
  }
  // A zip bomb: 64 kB that expand to 65 MB.
  const std::string zeros(std::size_t{65} << 20, ' ');
  const auto bomb = path.parent_path() / "bomb.x3p";
  zipFile bombs = zipOpen(bomb.c_str(), APPEND_STATUS_CREATE);
  zipOpenNewFileInZip(bombs, "main.xml", nullptr, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, 1);
  zipWriteInFileInZip(bombs, zeros.data(), static_cast<unsigned>(zeros.size()));
  zipCloseFileInZip(bombs);
  zipClose(bombs, nullptr);
  zipClose(zip, nullptr);

  Lines warnings;
  EXPECT_TRUE(isProfilometerFile(path));
  expectHeights(readMeasuredHeights(path, warnings), wholeNumbers(kRows), 1);
  EXPECT_EQ(warnings, Lines{});
  expectRefused(readFile(bomb), "larger than");
  std::string cut = readFile(path);
  expectRefused(cut.substr(0, cut.size() - 30), "no whole zip archive");
  const std::size_t data = cut.find("bindata/data.bin") + 20;
  cut[data] = static_cast<char>(cut[data] ^ 0x55);
  EXPECT_NE(refusal(cut), "");
  std::filesystem::remove_all(path.parent_path());
}

TEST(X3p, HoldsListsOfPoints) {
  const std::string absolute = "<AxisType>A</AxisType><DataType>D</DataType>";
  X3pFile profile;
  profile.feature = "PRF";
  profile.size = X3pFile::list(3);
  profile.x = absolute;
  profile.setInline({"1e-3;5e-6", "1.5e-3;-6e-6", "2.5e-3;0"});
  const MeasuredHeights line = parsed(profile.bytes());
  EXPECT_EQ(line.along, (std::vector<double>{1e-3, 1.5e-3, 2.5e-3}));
  EXPECT_EQ(line.heights, (std::vector<double>{5e-6, -6e-6, 0}));

  profile.setInline({"0;1", "1e-3;2", "2e-3;3", "3e-3;4", "4e-3;5", "5e-3;6", "6e-3;7", "7e-3;8",
                     "8e-3;9", "", "1e-2;1"});
  profile.size = X3pFile::list(11);
  Lines warnings;
  EXPECT_EQ(parsed(profile.bytes(), &warnings).along.size(), 10U);
  EXPECT_EQ(warnings, Lines{"file: 1 of 11 points were not measured and are left out"});

  // Points of a cloud in any order: x as doubles, y as numbers of 2 um, z as floats.
  X3pFile cloud;
  cloud.feature = "PCL";
  cloud.x = absolute;
  cloud.y = "<AxisType>A</AxisType><DataType>I</DataType><Increment>2e-6</Increment>";
  cloud.z = "<AxisType>A</AxisType><DataType>F</DataType><Increment>1e-6</Increment>";
  cloud.size = X3pFile::list(kColumns * kRows);
  const std::vector<double> values = wholeNumbers(kRows);
  std::vector<std::size_t> order(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(4));
  std::string bytes;
  Lines points;
  for (const std::size_t i : order) {
    const double x = 1e-3 + 5e-6 * static_cast<double>(i % kColumns);
    const auto y = static_cast<double>(i / kColumns);
    bytes += test::bytesAs('D', {x}) + test::bytesAs('I', {y}) + test::bytesAs('F', {values[i]});
    points.push_back(formatNumber(x) + ";" + formatNumber(y) + ";" + formatNumber(values[i]));
  }
  for (const bool binary : {false, true}) {
    if (binary)
      cloud.setBinary(bytes);
    else
      cloud.setInline(points);
    const MeasuredHeights area = parsed(cloud.bytes());
    expectHeights(area, values, 1e-6);
    EXPECT_EQ(area.columns, kColumns);
    EXPECT_NEAR(area.step_x, 5e-6, 1e-15);
    EXPECT_NEAR(area.step_y, 2e-6, 1e-15);
  }
}

// One or two of 28 points are missing: by an empty element, NaN, or a bit mask.
TEST(X3p, MarksUnmeasuredPoints) {
  std::vector<double> values(kColumns * kRows);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<double>(3 * (i % kColumns) + 10 * (i / kColumns));
  const auto check = [&](const X3pFile& file) {
    Lines warnings;
    expectHeights(parsed(file.bytes(), &warnings), values, 1); // linear along x
    EXPECT_EQ(warnings, Lines{"file: 2 of 28 points were not measured and are interpolated"});
  };
  X3pFile file;
  file.size = X3pFile::matrix(kColumns, kRows);
  Lines texts = allNames(values);
  texts[9] = texts[10] = "";
  file.setInline(texts);
  check(file);
  std::vector<double> spoilt = values;
  spoilt[9] = spoilt[10] = std::nan("");
  file.setBinary(test::bytesAs('D', spoilt));
  check(file);
  spoilt[9] = spoilt[10] = 77;
  std::string mask("\xFF\xF9\xFF\xFF");
  file.setBinary(test::bytesAs('D', spoilt), mask);
  check(file);
  mask.assign(28, '\1');
  mask[9] = mask[10] = '\0';
  file.setBinary(test::bytesAs('D', spoilt), mask);
  check(file);

  texts[3] = "";
  file.setInline(texts);
  expectRefused(file.bytes(), "3 of 28 points were not measured, more than 10 %");
}

TEST(X3p, IsRejectedIfInconsistent) {
  X3pFile good;
  good.size = X3pFile::matrix(kColumns, kRows);
  good.setBinary(test::bytesAs('D', wholeNumbers(kRows)));
  ASSERT_EQ(refusal(good.bytes()), "");
  const auto with = [&](const auto& change) {
    X3pFile file = good;
    change(file);
    return file.bytes();
  };
  expectRefused(with([](X3pFile& f) { f.files["bindata/data.bin"][0] ^= 1; }),
                "bindata/data.bin does not have the checksum");
  expectRefused(with([](X3pFile& f) { f.size = X3pFile::matrix(kColumns, 1000); }),
                "224 bytes of points where 7,000 of them have 56,000");
  expectRefused(with([](X3pFile& f) { f.size = X3pFile::matrix(3, 2); }), "larger than");
  expectRefused(with([](X3pFile& f) { f.size = X3pFile::matrix(1000000, 1000000); }),
                "1,000,000 x 1,000,000 points; at most");
  expectRefused(with([](X3pFile& f) { f.size = X3pFile::matrix(0, 4); }), "SizeX is 0");
  expectRefused(with([](X3pFile& f) { f.size = X3pFile::matrix(7, 2, 2); }), "several layers");
  expectRefused(with([](X3pFile& f) { f.feature = "PRF"; }), "a profile has several rows");
  expectRefused(with([](X3pFile& f) { f.feature = "XYZ"; }), "FeatureType");
  expectRefused(
      with([](X3pFile& f) { f.x = "<AxisType>I</AxisType><Increment>-1e-6</Increment>"; }),
      "step along x is -1e-06 m");
  expectRefused(with([](X3pFile& f) { f.x = "<AxisType>I</AxisType>"; }), "CX/Increment");
  expectRefused(with([](X3pFile& f) { f.z = "<AxisType>A</AxisType>"; }), "CZ/DataType");
  expectRefused(with([](X3pFile& f) { f.z = "<AxisType>A</AxisType><DataType>I</DataType>"; }),
                "CZ/Increment");
  const auto linkedTo = [&](const std::string& link) {
    return with([&](X3pFile& f) {
      f.data = "<DataLink><PointDataLink>" + link + "</PointDataLink></DataLink>";
    });
  };
  for (const char* link : {"/etc/passwd", "../data.bin", "C:\\data.bin", "bindata/../../x", ""})
    expectRefused(linkedTo(link), "is no path within the archive");
  expectRefused(linkedTo("bindata/none.bin"), "has no bindata/none.bin");
  Lines warnings;
  parsed(linkedTo("bindata\\data.bin"), &warnings);
  EXPECT_EQ(warnings, Lines{"file: bindata/data.bin has no checksum and was not checked"});
  expectRefused(with([](X3pFile& f) { f.setInline({"1", "2"}); }), "it has 2 points and says 28");
  expectRefused(with([](X3pFile& f) { f.setInline(Lines(28, "1;2")); }), "the axes need 1");
  expectRefused(with([](X3pFile& f) { f.setInline({"1", "2;3"}); }), "more numbers than another");
  expectRefused(with([](X3pFile& f) { f.setInline({"one"}); }), "main.xml, line 5");
  expectRefused(
      with([](X3pFile& f) { f.setBinary(f.files["bindata/data.bin"], std::string(9, '\xFF')); }),
      "whether they are valid");
  expectRefused(
      with([](X3pFile& f) { f.setBinary(test::bytesAs('D', std::vector<double>(28, 1e30))); }),
      "is its unit right?");
  expectRefused(with([](X3pFile& f) { f.data += "<a>"; }), "main.xml, line 5: mismatched tag");
  std::string deep;
  for (int i = 0; i < 1000; ++i) deep += "<a>";
  expectRefused(with([&](X3pFile& f) { f.data += deep; }), "nested too deep");

  auto members = good.members();
  members["main.xml"] += " ";
  expectRefused(test::storedZip(members), "checksum of md5checksum.hex");
  members.erase("md5checksum.hex");
  warnings.clear();
  parsed(test::storedZip(members), &warnings);
  EXPECT_EQ(warnings, Lines{"file: main.xml has no checksum and was not checked"});
  members["main.xml"] = "<!DOCTYPE a [<!ENTITY b \"bb\"><!ENTITY c \"&b;&b;\">]><a>&c;</a>";
  expectRefused(test::storedZip(members), "document type");
  members["main.xml"] = "<" + std::string(200, 'a') + "/>"; // expat ends what was refused, too
  expectRefused(test::storedZip(members), "too long names");
  members["main.xml"] = "<html/>";
  expectRefused(test::storedZip(members), "not that of an X3P");
  members.erase("main.xml");
  expectRefused(test::storedZip(members), "without main.xml");
  expectRefused("PK\3\4 and no more", "no whole zip archive");
}

TEST(Sdf, HoldsEachTypeAsTextAndBinary) {
  using Write = std::string (*)(const std::vector<double>&);
  const Write writes[] = {test::bytesOf<std::uint8_t>,  test::bytesOf<std::uint16_t>,
                          test::bytesOf<std::uint32_t>, test::bytesOf<float>,
                          test::bytesOf<std::int8_t>,   test::bytesOf<std::int16_t>,
                          test::bytesOf<std::int32_t>,  test::bytesOf<double>};
  for (const char* version : {"ISO-1.0", "ISO-2.0", "BCR-1.0"})
    for (const std::size_t rows : {std::size_t{1}, kRows})
      for (int type = 0; type < 8; ++type) {
        SCOPED_TRACE(std::string(version) + " " + std::to_string(type));
        SdfFile file;
        file.version = version;
        file.points = kColumns;
        file.profiles = static_cast<std::uint32_t>(rows);
        file.data_type = type;
        if (rows == 1) file.y_scale = 0;
        const std::vector<double> values = wholeNumbers(rows, type < 3 ? 0 : -120);
        for (const std::string& bytes : {file.text(joinedBy(" \r\n", allNames(values))),
                                         file.binary(writes[type](values) + "\r\ntrailer")}) {
          const MeasuredHeights measured = parsed(bytes);
          expectHeights(measured, values, 1e-9);
          EXPECT_EQ(measured.rows, rows);
          EXPECT_EQ(measured.columns, kColumns);
          EXPECT_EQ(measured.step_y, rows > 1 ? 2e-6 : 0);
        }
      }
}

TEST(Sdf, MarksUnmeasuredPoints) {
  SdfFile file;
  file.points = kColumns;
  file.profiles = kRows;
  std::vector<double> values(kColumns * kRows);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = 10 * static_cast<double>(i / kColumns);
  Lines texts = allNames(values);
  texts[8] = texts[13] = "BAD";
  const auto check = [&](const std::string& bytes) {
    Lines warnings;
    expectHeights(parsed(bytes, &warnings), values, 1e-9);
    EXPECT_EQ(warnings, Lines{"file: 2 of 28 points were not measured and are interpolated"});
  };
  check(file.text(joinedBy(" ", texts)));
  std::vector<double> spoilt = values;
  spoilt[8] = spoilt[13] = -32768;
  file.data_type = 5;
  check(file.binary(test::bytesOf<std::int16_t>(spoilt)));
  spoilt[8] = spoilt[13] = std::numeric_limits<double>::lowest();
  file.data_type = 7;
  check(file.binary(test::bytesOf<double>(spoilt)));

  // A missing row repeats the row before it; a missing point of a profile is omitted.
  for (std::size_t i = 0; i < kColumns; ++i) texts[i] = "BAD";
  expectRefused(file.text(joinedBy(" ", texts)), "9 of 28 points");
  file.points = 12;
  file.profiles = 1;
  texts = allNames(std::vector<double>(12, 4));
  texts[5] = "BAD";
  Lines warnings;
  const MeasuredHeights line = parsed(file.text(joinedBy(" ", texts)), &warnings);
  EXPECT_EQ(warnings, Lines{"file: 1 of 12 points were not measured and are left out"});
  ASSERT_EQ(line.along.size(), 11U);
  EXPECT_NEAR(line.along[5], 6e-6, 1e-15);
}

TEST(Sdf, IsRejectedIfInconsistent) {
  SdfFile good;
  good.points = kColumns;
  good.profiles = kRows;
  const std::string heights = joinedBy(" ", allNames(wholeNumbers(kRows)));
  const std::string numbers = test::bytesOf<double>(wholeNumbers(kRows));
  const auto expectBoth = [&](const auto& change, const std::string& cause) {
    SdfFile file = good;
    change(file);
    expectRefused(file.text(heights), cause);
    expectRefused(file.binary(numbers), cause);
  };
  expectBoth([](SdfFile& f) { f.profiles = 40000; }, "of 280,000 points");
  expectBoth([](SdfFile& f) { f.points = f.profiles = 65535; }, "at most 16,777,216");
  expectBoth([](SdfFile& f) { f.points = 0; }, "NumPoints or NumProfiles is 0");
  expectBoth([](SdfFile& f) { f.x_scale = -1e-6; }, "Xscale is -1e-06 m");
  expectBoth([](SdfFile& f) { f.y_scale = 0; }, "Yscale is 0 m");
  expectBoth([](SdfFile& f) { f.z_scale = 0; }, "Zscale is 0");
  expectBoth([](SdfFile& f) { f.z_scale = std::nan(""); }, "Zscale is");
  expectBoth([](SdfFile& f) { f.z_scale = 1e3; }, "is its unit right?");
  expectBoth([](SdfFile& f) { f.compression = 1; }, "is compressed");
  expectBoth([](SdfFile& f) { f.check_type = 1; }, "has a checksum");
  expectBoth([](SdfFile& f) { f.data_type = 8; }, "DataType is 8");
  expectBoth([](SdfFile& f) { f.version = "ISO-9.9"; }, "version");
  std::string text = good.text(heights);
  expectRefused(good.text(heights + " 5"), "more heights");
  expectRefused(good.text("x " + heights), "file:15: has a height that is no number");
  expectRefused(text.substr(0, text.find('*')), "ends within its header");
  expectRefused(good.binary(numbers).substr(0, 60), "ends within its header");
  expectRefused(good.binary(numbers).substr(0, 200), "ends after 14 of 28 points");
  text.replace(text.find("Zscale"), 6, "Wscale");
  expectRefused(text, "has no Zscale");
}

TEST(GwyddionText, IsAnAreaWhoseFirstRowIsTheTop) {
  const std::string matrix = "1\t2\t3\n4\t5\t6\n";
  const std::vector<double> due{4e-9, 5e-9, 6e-9, 1e-9, 2e-9, 3e-9};
  const std::string headers[] = {
      "# Channel: Topo\n# Width: 6 \xC2\xB5m\n# Height: 8.0 nm\n# Value units: nm\n",
      "# Kanal: H\xC3\xB6he\r\n# Breite: 6,000 \xC2\xB5m\r\n# H\xC3\xB6he: 8,0 nm\r\n# "
      "Werteinheiten: nm\r\n",
      "# \xE3\x83\x81\xEF\xBC\x9A Topo\n# \xE5\xB9\x85\xEF\xBC\x9A 6 um\n# "
      "\xE9\xAB\x98\xE3\x81\x95\xEF\xBC\x9A 8 nm\n# \xE5\x80\xA4\xEF\xBC\x9A nm\n"};
  for (const std::string& header : headers) {
    const MeasuredHeights area = parsed(header + matrix);
    EXPECT_EQ(area.columns, 3U);
    EXPECT_EQ(area.rows, 2U);
    EXPECT_NEAR(area.step_x, 2e-6, 1e-18);
    EXPECT_NEAR(area.step_y, 4e-9, 1e-20);
    for (std::size_t i = 0; i < due.size(); ++i) EXPECT_NEAR(area.heights[i], due[i], 1e-20);
  }
  expectRefused(headers[0] + "1 2 3\n4 5\n", "row 2 of the matrix has 2 values, the first has 3");
  expectRefused(headers[0] + "1 2 3\n4 5 six\n", "file:6: has a value that is no number");
  expectRefused(headers[0], "no matrix");
  expectRefused("# Channel: Topo\n" + matrix, "lacks lines");
  expectRefused("# Channel: Topo\n# Width: 6\n# Height: 8\n# Value units: m\n" + matrix,
                "lacks lines");
  expectRefused("# Channel: Current\n# Width: 6 um\n# Height: 8 um\n# Value units: A\n" + matrix,
                "lacks lines");
  expectRefused("# Channel: Topo\n# Width: -6 um\n# Height: 8 um\n# Value units: m\n" + matrix,
                "step along x");
}

TEST(HeightTable, IsAProfileByItsColumnsAndUnits) {
  for (const std::string text :
       {"x [mm],z [um]\n0,1\n0.5,2\n2,3\n", "x [mm];y (um)\n2;3\n0,5;2\n0;1\n",
        "# measured today\n# x [mm], z [um]\n0,1\n0.5,2\n2,3\n",
        "z [um]\tx [mm]\n1\t0\n2\t0.5\n3\t2\n"}) {
    const MeasuredHeights line = parsed(text);
    EXPECT_FALSE(line.isArea());
    EXPECT_EQ(line.along, (std::vector<double>{0, 0.5e-3, 2e-3})) << text;
    EXPECT_EQ(line.heights, (std::vector<double>{1e-6, 2e-6, 3e-6})) << text;
  }
  expectRefused("x [mm],z\n0,1\n", "has no unit");
  expectRefused("x,z [um]\n0,1\n", "has no unit");
  expectRefused("x [mm],w [um]\n0,1\n", "no height");
  expectRefused("x [mm],z [kg]\n0,1\n", "not in a known unit");
  expectRefused("x [mm],z [um]\n", "no points");
  expectRefused("x [mm],z [um]\n0,1\n2,1\n1,1\n", "x runs backwards");
  expectRefused("x [mm],z [um]\n0,1\nnan,1\n", "file:3: x or y is not a finite number");
  expectRefused("x [km],z [um]\n0,1\n5,1\n", "is its unit right?");
}

TEST(HeightTable, IsAnAreaByPointsOfAGridInAnyOrder) {
  const std::vector<double> values = wholeNumbers(kRows);
  Lines rows;
  for (std::size_t i = 0; i < values.size(); ++i)
    rows.push_back(formatNumber(0.3 * static_cast<double>(i % kColumns)) + "," +
                   formatNumber(-2 + 0.7 * static_cast<double>(i / kColumns)) + "," +
                   formatNumber(values[i]) + "\n");
  std::shuffle(rows.begin(), rows.end(), std::mt19937(5));
  const std::string header = "x [mm],y [mm],z [um]\n";
  const MeasuredHeights area = parsed(header + joinedBy("", rows));
  expectHeights(area, values, 1e-6);
  EXPECT_NEAR(area.step_x, 0.3e-3, 1e-15);
  EXPECT_NEAR(area.step_y, 0.7e-3, 1e-15);

  Lines warnings;
  Lines fewer(rows.begin(), rows.end() - 2);
  EXPECT_EQ(parsed(header + joinedBy("", fewer), &warnings).heights.size(), 28U);
  EXPECT_EQ(warnings, Lines{"file: 2 of 28 points were not measured and are interpolated"});
  fewer.pop_back();
  expectRefused(header + joinedBy("", fewer), "grid");
  expectRefused(header + joinedBy("", rows) + rows[0], "two points at");
  expectRefused(header + joinedBy("", rows) + "0.45,-2,1\n", "grid");
  expectRefused(header + "0,0,1\n1,0,1\n2,0,1\n3,0,1\n", "grid");
}

// A wave over the area after cropping, levelling and resampling of unequal steps.
TEST(SquareArea, BecomesATextureWithTheWavesOfTheArea) {
  constexpr double kWave = 1e-3, kHigh = 2e-6;
  const auto areaOf = [](std::size_t columns, std::size_t rows, double step_x, double step_y) {
    MeasuredHeights area;
    area.columns = columns;
    area.rows = rows;
    area.step_x = step_x;
    area.step_y = step_y;
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < columns; ++c) {
        const double x = static_cast<double>(c) * step_x, y = static_cast<double>(r) * step_y;
        area.heights.push_back(5e-3 + 0.02 * x - 0.01 * y +
                               kHigh * std::cos(2 * std::numbers::pi * x / kWave));
      }
    return area;
  };
  for (const auto& [area, side] :
       {std::pair{areaOf(401, 401, 1e-5, 1e-5), 401}, std::pair{areaOf(501, 401, 1e-5, 1e-5), 401},
        std::pair{areaOf(401, 101, 1e-5, 4e-5), 401},
        std::pair{areaOf(101, 401, 4e-5, 1e-5), 401}}) {
    Lines warnings;
    const SquareArea square = squareOf(area, warnings);
    EXPECT_EQ(square.picture.width, side);
    EXPECT_EQ(square.picture.height, side);
    EXPECT_EQ(warnings.size(), area.columns == area.rows ? 0U : 1U);
    EXPECT_NEAR(square.length, 401e-5, 1e-9);
    EXPECT_NEAR(square.height, 2 * kHigh, 0.15 * kHigh);
    PlaneFitOptions options;
    options.length = square.length;
    options.height = square.height;
    options.blend = 0.01;
    Progress progress;
    const FourierTexture texture = fitPlane(square.picture, options, progress).texture;
    EXPECT_NEAR(period(texture), 4e-3, 1e-9);
    EXPECT_NEAR(rmsHeight(texture), kHigh / std::numbers::sqrt2, 0.03 * kHigh);
  }
  Lines warnings;
  EXPECT_THROW(squareOf(areaOf(10, 1, 1e-5, 0), warnings), Error);
  EXPECT_THROW(squareOf(areaOf(9000, 3, 1e-6, 1e-2), warnings), Error);
  MeasuredHeights flat = areaOf(20, 20, 1e-5, 1e-5);
  std::fill(flat.heights.begin(), flat.heights.end(), 0.125);
  EXPECT_THROW(squareOf(flat, warnings), Error);
}

TEST(ProfilometerFile, IsRecognisedByItsContent) {
  const auto folder = test::freshFolder("heights");
  const auto isOne = [&](const std::string& bytes) {
    writeFileAtomically(folder / "file", bytes);
    return isProfilometerFile(folder / "file");
  };
  EXPECT_TRUE(isOne("x [mm],z [um]\n0,1\n"));
  EXPECT_TRUE(isOne(std::string("\xFF\xFEx\0 \0[\0m\0m\0]\0,\0z\0", 22)));
  EXPECT_TRUE(isOne("aISO-1.0\n"));
  EXPECT_FALSE(isOne("along [m],height [m]\n0,1\n"));
  EXPECT_FALSE(isOne("t [s],x [m],along [m],height [m]\n0,0,0,1\n"));
  EXPECT_FALSE(isOne("\x89PNG\r\n\x1a\n,x[,x["));
  EXPECT_FALSE(isOne(""));
  EXPECT_FALSE(isOne("abc"));
  EXPECT_FALSE(isProfilometerFile(folder));
  EXPECT_FALSE(isProfilometerFile("-"));
  std::filesystem::remove_all(folder);
}

} // namespace
} // namespace patina
