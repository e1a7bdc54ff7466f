// Volumes whose header asks for more than the file can mean: one line, before VTK reads them.
#include <fstream>

#include <gtest/gtest.h>

#include <vtkBase64Utilities.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataWriter.h>

#include "core/error.h"
#include "core/file.h"
#include "support/fresh_folder.h"
#include "visualization/files/field_io.h"
#include "visualization/files/xml_tags.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class VolumeBounds : public ::testing::Test {
 protected:
  void SetUp() override { folder_ = test::freshFolder("volume_bounds"); }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& bytes) const {
    std::ofstream(folder_ / "v.vti", std::ios::binary) << bytes;
    return folder_ / "v.vti";
  }
  // The message of reading the volume in each way; all ways must agree that it is bad.
  std::string refusal(const std::string& bytes) const {
    const fs::path path = write(bytes);
    std::string message;
    for (const auto& read : std::initializer_list<std::function<void()>>{
             [&] { (void)isField(path); }, [&] { (void)readField(path); },
             [&] { (void)scalarRange(path); }})
      try {
        read();
        ADD_FAILURE() << "was read: " << bytes.substr(0, 400);
      } catch (const FileError& error) {
        message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_LT(message.size(), 500u);
      }
    return message;
  }

 private:
  fs::path folder_;
};

std::string repeated(std::string_view text, std::size_t count) {
  std::string all;
  all.reserve(count * text.size());
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

std::string volume(const std::string& inside, const std::string& extent = "0 1 0 1 0 1") {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<ImageData WholeExtent=\"" +
         extent + "\" Origin=\"0 0 0\" Spacing=\"1 1 1\">\n<Piece Extent=\"" + extent + "\">\n" +
         inside + "\n</Piece>\n</ImageData>\n</VTKFile>\n";
}

std::string points(const std::string& attributes, const std::string& values) {
  return "<PointData><DataArray Name=\"x\" format=\"ascii\" " + attributes + ">" + values +
         "</DataArray></PointData>";
}

TEST_F(VolumeBounds, OrdinaryVolumeIsRead) {
  const fs::path path = write(volume(points("type=\"Float64\"", "1 2 3 4 5 6 7 8")));
  EXPECT_FALSE(isField(path));
  EXPECT_EQ(scalarRange(path).high, 8);
}

TEST_F(VolumeBounds, NestedElementsAreRefused) {
  for (const std::size_t levels : {std::size_t{33}, std::size_t{333}, std::size_t{3000000}}) {
    EXPECT_NE(refusal(volume(repeated("<a>", levels))).find("32 levels"), std::string::npos);
    EXPECT_NE(refusal(volume(repeated("<a>", levels) + repeated("</a>", levels))).find("32 levels"),
              std::string::npos);
  }
}

TEST_F(VolumeBounds, ManyElementsAndLongTagsAreRefused) {
  EXPECT_NE(refusal(volume(repeated("<a/>", 2000000))).find("10000 elements"), std::string::npos);
  EXPECT_NE(refusal(volume("<a " + repeated("b", 10000) + "=\"\"/>")).find("8 kB"),
            std::string::npos);
  EXPECT_NE(refusal(volume("<!--" + repeated("x", 5000000) + "-->")).find("4 MB"),
            std::string::npos);
  EXPECT_NE(refusal(volume("<a b='" + repeated("x", 5000000))).find("4 MB"), std::string::npos);
}

TEST_F(VolumeBounds, OpenElementsAndDocumentTypesAreRefused) {
  const std::string whole = volume(points("type=\"Float64\"", "1 2 3 4 5 6 7 8"));
  EXPECT_NE(refusal(whole.substr(0, whole.size() - 12)).find("no end"), std::string::npos);
  EXPECT_NE(refusal(volume("</Piece></Piece></Piece></Piece>")).find("not begun"),
            std::string::npos);
  EXPECT_NE(refusal("<!DOCTYPE a [<!ENTITY b \"c\">]>" + whole).find("document type"),
            std::string::npos);
}

TEST_F(VolumeBounds, ArraysThatTheFileCannotHoldAreRefused) {
  const std::string wide = "0 1023 0 1023 0 511"; // 2^29 nodes
  EXPECT_NE(refusal(volume(points("type=\"Float64\"", "1"), wide)).find("cannot hold"),
            std::string::npos);
  EXPECT_NE(refusal(volume(points("type=\"Int8\" NumberOfComponents=\"2000000000\"", "1")))
                .find("cannot hold"),
            std::string::npos);
  const std::string field = "<FieldData><DataArray type=\"Float64\" Name=\"grid [m]\" "
                            "NumberOfTuples=\"2000000000\" format=\"ascii\">1</DataArray>"
                            "</FieldData>";
  std::string bytes = volume(points("type=\"Float64\"", "1 2 3 4 5 6 7 8"));
  bytes.insert(bytes.find("<Piece"), field);
  EXPECT_NE(refusal(bytes).find("cannot hold"), std::string::npos);
}

TEST_F(VolumeBounds, PiecesThatAreNotInTheirVolumeAreRefused) {
  const std::string whole = volume(points("type=\"Float64\"", "1 2 3 4 5 6 7 8"));
  for (const char* extent : {"0 2 0 1 0 1", "-1 1 0 1 0 1", "1 0 0 1 0 1", "0 1 0 1 0", "",
                             "0 1 0 -1 0 1", "0 -1 0 -1 0 -1"}) {
    std::string bytes = whole;
    const std::size_t at = bytes.find("Piece Extent=\"") + 14;
    bytes.replace(at, bytes.find('"', at) - at, extent);
    EXPECT_NE(refusal(bytes).find("Extent"), std::string::npos) << extent;
  }
}

TEST_F(VolumeBounds, WhatVtkReadsIsRead) {
  const std::string whole = volume(points("type=\"Float64\"", "1 2 3 4 5 6 7 8"));
  const auto isRead = [&](const std::string& before, const std::string& added) {
    std::string bytes = whole;
    bytes.insert(bytes.find(before), added);
    EXPECT_EQ(scalarRange(write(bytes)).high, 8) << added;
  };
  const std::string data = "<FieldData><DataArray type=\"Float64\" Name=\"a\" "
                           "NumberOfTuples=\"1\" format=\"ascii\">1</DataArray></FieldData>";
  isRead("<Piece", data);
  isRead("</ImageData", data);
  isRead("</ImageData", "<Piece Extent=\"0 -1 0 -1 0 -1\"><PointData/></Piece>");
  isRead("Extent=\"0 1 0 1 0 1\">\n<PointData", "Name=\"p>0\" ");
}

// VTK reads an array that it could not make.
TEST_F(VolumeBounds, ArraysOfUnknownTypesAreRefused) {
  const std::string whole = volume(points("type=\"Float64\"", "1 2 3 4 5 6 7 8"));
  for (const char* array :
       {"<DataArray type=\"Float.4\" Name=\"a\" NumberOfTuples=\"1\" "
        "format=\"ascii\">1</DataArray>",
        "<DataArray Name=\"a\" NumberOfTuples=\"1\">1</DataArray>", "<a/>",
        "<FieldData Name=\"a\" type=\"Float65\"/>", "<PointData Name=\"a\" type=\"Float65\"/>"}) {
    std::string bytes = whole;
    bytes.insert(bytes.find("<Piece"), std::string("<FieldData>") + array + "</FieldData>");
    EXPECT_NE(refusal(bytes).find("truncated or damaged"), std::string::npos);
  }
  EXPECT_NE(refusal(volume(points("type=\"Float99\"", "1"))).find("no known type"),
            std::string::npos);
}

enum class Encoding { inline_base64, base64, raw };

void writeZeros(const fs::path& path, int nodes, Encoding encoding) {
  const vtkNew<vtkImageData> image;
  image->SetDimensions(nodes, nodes, nodes);
  const vtkNew<vtkFloatArray> zeros;
  zeros->SetName("zeros");
  zeros->SetNumberOfTuples(image->GetNumberOfPoints());
  zeros->Fill(0);
  image->GetPointData()->SetScalars(zeros);
  const vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetInputData(image);
  writer->SetFileName(path.c_str());
  writer->SetCompressorTypeToZLib();
  writer->SetCompressionLevel(9);
  writer->SetHeaderTypeToUInt32();
  if (encoding == Encoding::inline_base64) writer->SetDataModeToBinary();
  if (encoding == Encoding::raw) writer->EncodeAppendedDataOff();
  ASSERT_EQ(writer->Write(), 1);
}

TEST_F(VolumeBounds, BlocksThatCannotBeAreRefused) {
  for (const Encoding encoding : {Encoding::inline_base64, Encoding::base64, Encoding::raw}) {
    const fs::path path = write("");
    writeZeros(path, 8, encoding);
    EXPECT_EQ(scalarRange(path).high, 0);
    const std::string whole = readFile(path);
    std::size_t at = encoding == Encoding::inline_base64
                         ? whole.find('>', whole.find("format=\"binary\"")) + 1
                         : whole.find('_', whole.find("<AppendedData")) + 1;
    at = whole.find_first_not_of(" \n", at);
    // The first numbers are the blocks, the bytes of each, and those of a shorter last one.
    using Numbers = std::array<std::uint32_t, 3>;
    for (const Numbers& numbers :
         {Numbers{~0U, ~0U, 0}, Numbers{1, 0, 0}, Numbers{0, 0, 32}, Numbers{0, 32, 16}}) {
      std::string head(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
      if (encoding != Encoding::raw) {
        std::string digits(16, '\0');
        vtkBase64Utilities::Encode(reinterpret_cast<const unsigned char*>(head.data()), head.size(),
                                   reinterpret_cast<unsigned char*>(digits.data()));
        head = digits;
      }
      std::string bytes = whole;
      bytes.replace(at, head.size(), head);
      EXPECT_NE(refusal(bytes).find("an array's blocks"), std::string::npos);
    }
  }
}

// VTK follows an offset whatever the format is, and finds the appended data in a comment, too.
TEST_F(VolumeBounds, BlocksThatCannotBeAreFoundWhereTheReaderFindsThem) {
  const fs::path path = write("");
  writeZeros(path, 8, Encoding::raw);
  const std::string whole = readFile(path);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string bytes = whole;
    bytes.replace(whole.find('_', whole.find("<AppendedData")) + 1, 8, std::string(8, '\0'));
    return bytes.replace(bytes.find(from), from.size(), to);
  };
  for (const auto& bytes :
       {changed("format=\"appended\"", "format=\"binary\""),
        changed("offset=\"0\"", "offset=\"0x\""),
        changed("<ImageData ", "<!-- <AppendedData>_ --><ImageData "),
        changed("<AppendedData ", "<AppendedData a=\">\" "),
        changed("<ImageData ", "<VTKFile/><ImageData "), changed("\">\n   _", "\">\n   W_")})
    EXPECT_NE(refusal(bytes).find("truncated or damaged: "), std::string::npos);
}

TEST_F(VolumeBounds, ConstantVolumeIsReadHoweverSmallItsFile) {
  const fs::path path = write("");
  writeZeros(path, 128, Encoding::base64);
  ASSERT_LT(fs::file_size(path), 128u * 128 * 128 * 4 / 100);
  EXPECT_EQ(scalarRange(path).high, 0);
}

TEST_F(VolumeBounds, FieldWithoutItsPiecesIsRefused) {
  FieldSpec spec;
  spec.resolution = 16;
  spec.band = 3;
  const Box3 box(Vec3::Constant(-0.03), Vec3::Constant(0.03));
  const fs::path path = write("");
  writeField(path, sampleFunction([](const Vec3& p) { return p.norm() - 0.03; },
                                  gridAround(box, spec), spec.band));
  const std::string whole = readFile(path);
  const std::size_t at = whole.find("WholeExtent=\"") + 13;
  const std::string head = whole.substr(0, at);
  const std::string tail = whole.substr(whole.find('"', at));
  const auto message = [&](const std::string& bytes) -> std::string {
    try {
      (void)readField(write(bytes));
    } catch (const FileError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(whole), "");
  EXPECT_NE(message(head + "0 999999 0 999999 0 999999" + tail).find("its pieces are not"),
            std::string::npos);
  EXPECT_NE(message(head + repeated("<", 5000000)).find("truncated or damaged"), std::string::npos);
  EXPECT_NE(message(head + repeated("<", 5000000) + tail).find("damaged"), std::string::npos);
}

TEST(XmlTags, AttributesAreFoundByTheirName) {
  const std::string_view tag = "Piece a=\"b='1'\" b = '2 3'\n\tbc=\"\"";
  EXPECT_EQ(attributeOf(tag, "a"), "b='1'");
  EXPECT_EQ(attributeOf(tag, "b"), "2 3");
  EXPECT_EQ(attributeOf(tag, "bc"), "");
  EXPECT_EQ(attributeOf(tag, "c"), "");
  EXPECT_EQ(attributeOf("Piece a=\"1", "a"), "");
}

} // namespace
} // namespace patina
