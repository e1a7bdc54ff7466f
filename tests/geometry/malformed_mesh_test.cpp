// Every file in tests/geometry/malformed is refused with its line and a cause (MATH 2.8, Files).
#include <set>

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/io/mesh_io.h"
#include "support/places.h"

namespace patina {
namespace {

struct Malformed {
  std::string file;
  std::size_t line;  // 0: binary data
  std::string cause; // a part of it
};

std::filesystem::path folder() {
  return test::sourceFolder() / "tests/geometry/malformed";
}

void expectRefused(const std::string& format, const std::vector<Malformed>& files) {
  std::set<std::string> untested;
  for (const auto& entry : std::filesystem::directory_iterator(folder() / format))
    untested.insert(entry.path().filename().string());
  EXPECT_GE(untested.size(), files.size());
  for (const Malformed& malformed : files) {
    SCOPED_TRACE(malformed.file);
    untested.erase(malformed.file);
    const std::filesystem::path path = folder() / format / malformed.file;
    try {
      readMesh(path);
      ADD_FAILURE() << "was read";
    } catch (const FileError& error) {
      const std::string what = error.what();
      EXPECT_EQ(error.path(), path.string());
      EXPECT_EQ(error.line(), malformed.line) << what;
      EXPECT_NE(what.find(malformed.cause), std::string::npos) << what;
      EXPECT_EQ(what.find('\n'), std::string::npos) << "one line";
      // The project folder may have any name, so only the rest of the message is compared.
      for (const char c : what.substr(path.string().size()))
        EXPECT_TRUE(c >= 0x20 && c < 0x7f) << "printable";
    }
  }
  EXPECT_TRUE(untested.empty()) << *untested.begin() << " is not in the test's list";
}

TEST(MalformedMesh, ObjIsRefusedWithItsLine) {
  expectRefused(
      "obj",
      {
          {"binary_in_face.obj", 4, "binary data where a face's corner should be"},
          {"binary_in_vertex.obj", 2, "binary data where a coordinate should be"},
          {"continued_into_the_end.obj", 4, "a face needs 3 corners or more, this one has 2"},
          {"decimal_comma.obj", 2, "'0,5' has a decimal comma; numbers need a decimal point"},
          {"empty.obj", 1, "the file is empty"},
          {"four_part_corner.obj", 4, "'1/1/1/1' is not a face's corner (v, v/t, v//n or v/t/n)"},
          {"fraction_index.obj", 4, "'3.5' is not a face's corner (v, v/t, v//n or v/t/n)"},
          {"huge_index.obj", 4, "the face names vertex 99999999, but the file has 3"},
          {"index_beyond_int64.obj", 4,
           "the face names vertex '99999999999999999999999', more than a file can hold"},
          {"index_zero.obj", 4, "the face names vertex 0; OBJ counts from 1"},
          {"negative_index_too_far.obj", 4, "the face names vertex -4, but only 3 stand before it"},
          {"no_faces.obj", 3, "a point cloud of 3 points, not a mesh: it has no face"},
          {"not_quite_a_number.obj", 2,
           "'1e' is not a number; it stands where a coordinate should be"},
          {"number_too_large.obj", 2,
           "'1e999' is too large a number; it stands where a coordinate should be"},
          {"picture_named_obj.obj", 2, "binary data where OBJ text should be"},
          {"texture_without_number.obj", 4, "the line ends where a texture coordinate should be"},
          {"truncated_in_face.obj", 4, "a face needs 3 corners or more, this one has 2"},
          {"truncated_in_vertex.obj", 3, "the line ends where a coordinate should be"},
          {"two_coordinates.obj", 2, "the line ends where a coordinate should be"},
          {"utf16.obj", 1, "the text is UTF-16; save it as UTF-8"},
          {"word_for_number.obj", 2,
           "'zero' is not a number; it stands where a coordinate should be"},
      });
}

TEST(MalformedMesh, PlyIsRefusedWithItsLineOrByte) {
  expectRefused(
      "ply",
      {
          {"binary_data_left.ply", 0, "more data than the header says (byte 218)"},
          {"binary_in_ascii.ply", 11, "binary data where a property's value should be"},
          {"binary_in_header.ply", 3, "binary data is no statement of a PLY header"},
          {"binary_index_too_large.ply", 0,
           "the face names vertex 3, but the file has 3, counted from 0 (byte 218)"},
          {"binary_list_longer_than_file.ply", 0, "the file ends within its data (byte 218)"},
          {"binary_negative_length.ply", 0, "a list cannot have -3 entries (byte 205)"},
          {"binary_wrong_byte_order.ply", 0,
           "the face names vertex 16777216, but the file has 3, counted from 0 (byte 211)"},
          {"count_beyond_uint64.ply", 3,
           "the count '99999999999999999999999' is more than any file can hold"},
          {"count_negative.ply", 3, "element 'vertex' has no count but '-3'"},
          {"count_not_a_number.ply", 3, "element 'vertex' has no count but 'three'"},
          {"decimal_comma.ply", 11, "'1,25' has a decimal comma; numbers need a decimal point"},
          {"empty.ply", 1, "the file is empty"},
          {"face_of_two.ply", 13, "a face needs 3 corners or more, this one has 2"},
          {"faces_without_indices.ply", 7, "the faces have no list 'vertex_indices'"},
          {"float_indices.ply", 7, "the faces' vertex indices must have an integer type"},
          {"float_list_length.ply", 8, "a list's length must have an integer type"},
          {"index_fraction.ply", 13,
           "the face names vertex 1.5, but the file has 3, counted from 0"},
          {"index_negative.ply", 13,
           "the face names vertex -1, but the file has 3, counted from 0"},
          {"index_too_large.ply", 13,
           "the face names vertex 3, but the file has 3, counted from 0"},
          {"line_too_long.ply", 11, "'0' where the line should end"},
          {"line_too_short.ply", 11, "the line ends where a property's value should be"},
          {"list_length_negative.ply", 13, "a list cannot have this length"},
          {"list_longer_than_line.ply", 13, "the line ends where a property's value should be"},
          {"more_faces_than_bytes_binary.ply", 7,
           "the header says 4000000000 of element 'face', more than the 49 bytes after it can "
           "hold"},
          {"more_lines_than_counted.ply", 14, "more lines than the header says"},
          {"more_vertices_than_bytes_ascii.ply", 3,
           "the header says 4000000000 of element 'vertex', more than the 26 bytes after it can "
           "hold"},
          {"more_vertices_than_bytes_binary.ply", 3,
           "the header says 4000000000 of element 'vertex', more than the 49 bytes after it can "
           "hold"},
          {"no_face_element.ply", 7, "a point cloud of 1 point, not a mesh: it has no face"},
          {"no_faces.ply", 7, "a point cloud of 3 points, not a mesh: it has no face"},
          {"no_format.ply", 8, "the header names no format"},
          {"no_vertex_element.ply", 5, "the header has no element 'vertex'"},
          {"no_z.ply", 3, "the vertices have no property 'z'"},
          {"not_ply.ply", 1, "not a PLY file: it must begin with 'ply'"},
          {"property_before_element.ply", 3, "a property stands before the first element"},
          {"property_without_name.ply", 5, "the property has no name"},
          {"truncated_ascii.ply", 12, "the file ends where an item of element 'face' should be"},
          {"truncated_binary.ply", 0, "the file ends within its data (byte 214)"},
          {"truncated_header.ply", 3, "the file ends before 'end_header'"},
          {"unknown_format.ply", 2,
           "format 'ascii_utf8' is unknown; ascii, binary_little_endian and binary_big_endian are"},
          {"unknown_statement.ply", 7, "'elements' is no statement of a PLY header"},
          {"unknown_type.ply", 5, "type 'half' is unknown"},
          {"unknown_version.ply", 2, "PLY version '2.0' is unknown; 1.0 is"},
          {"vertex_element_twice.ply", 9, "element 'vertex' appears twice"},
          {"x_twice.ply", 3, "two properties like 'x'"},
      });
}

TEST(MalformedMesh, StlIsRefusedWithItsLineOrByte) {
  expectRefused(
      "stl",
      {
          {"binary_in_ascii.stl", 5, "binary data where a coordinate should be"},
          {"count_too_large.stl", 0,
           "the header at byte 80 says 1000000 triangles (50000084 bytes), but the file has 134 "
           "bytes"},
          {"decimal_comma.stl", 5, "'1,5' has a decimal comma; numbers need a decimal point"},
          {"empty.stl", 1, "the file is empty"},
          {"four_corners.stl", 7, "'vertex' where 'endloop' should be"},
          {"misspelt_keyword.stl", 3, "'lop' where 'loop' should be"},
          {"no_triangles_ascii.stl", 2, "the file has no triangle"},
          {"no_triangles_binary.stl", 0, "the file has no triangle (count at byte 80)"},
          {"other_text.stl", 1, "not an STL file: a text that does not begin with 'solid'"},
          {"short_binary.stl", 0, "not an STL file: it has 40 bytes, fewer than a binary header"},
          {"truncated_binary.stl", 0,
           "the header at byte 80 says 2 triangles (184 bytes), but the file has 154 bytes"},
          {"truncated_binary_named_solid.stl", 0,
           "the header at byte 80 says 2 triangles (184 bytes), but the file has 154 bytes"},
          {"truncated_in_facet.stl", 6, "the file ends where endloop should be"},
          {"truncated_in_number.stl", 6, "the file ends where a coordinate should be"},
          {"two_corners.stl", 6, "'endloop' where 'vertex' should be"},
          {"word_for_number.stl", 5,
           "'one' is not a number; it stands where a coordinate should be"},
      });
}

TEST(MalformedMesh, FolderMissingFileAndUnknownEndingAreRejected) {
  EXPECT_THROW(readMesh(folder() / "obj" / "absent.obj"), FileError);
  EXPECT_THROW(readMesh(folder() / "obj" / "mesh.gltf"), FileError);
  EXPECT_THROW(readMesh(folder() / "obj"), FileError);
  EXPECT_THROW(writeMesh(std::filesystem::temp_directory_path() / "mesh.gltf", {}), FileError);
}

// A file cut at any byte gives a mesh or a one-line error. A count is not trusted before its bytes
// are read.
TEST(MalformedMesh, EveryTruncationOfEveryFormatIsHandled) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 \\\n -1/1\n";
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                          "property float y\nproperty float z\nelement face 1\n"
                          "property list uchar int vertex_indices\nend_header\n"
                          "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                          "vertex 0 1 0\nendloop\nendfacet\nendsolid\n";
  const auto refusals = [](const std::string& bytes, auto parse) {
    std::size_t count = 0;
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      try {
        parse(std::string_view(bytes).substr(0, length), "cut");
      } catch (const FileError&) {
        ++count;
      }
    }
    EXPECT_NO_THROW(parse(bytes, "whole"));
    return count;
  };
  // OBJ and PLY are complete without the last newline; OBJ already when "1" of "1/1" is read.
  EXPECT_EQ(refusals(obj, [](auto... text) { parseObj(text...); }), obj.size() - 3);
  EXPECT_EQ(refusals(ply, [](auto... text) { parsePly(text...); }), ply.size() - 1);
  // STL too, also without its end, with or without the newline before it.
  EXPECT_EQ(refusals(stl, [](auto... text) { parseStl(text...); }), stl.size() - 3);
}

} // namespace
} // namespace patina
