// Files of profilometers, written independently of their readers.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/sha256.h"

namespace patina::test {

template <class Number> std::string bytesOf(const std::vector<double>& values) {
  std::string bytes;
  for (const double value : values) {
    const auto number = static_cast<Number>(value);
    char part[sizeof number];
    std::memcpy(part, &number, sizeof number);
    bytes.append(part, sizeof number);
  }
  return bytes;
}

// Packs the values in the data type of X3P's letter.
inline std::string bytesAs(char type, const std::vector<double>& values) {
  return type == 'I'   ? bytesOf<std::int16_t>(values)
         : type == 'L' ? bytesOf<std::int32_t>(values)
         : type == 'F' ? bytesOf<float>(values)
                       : bytesOf<double>(values);
}

// A zip archive without compression (APPNOTE 6.3, PKWARE).
inline std::string storedZip(const std::map<std::string, std::string>& files) {
  const auto number = [](std::uint64_t value, int size) {
    std::string bytes;
    for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 255);
    return bytes;
  };
  const auto crc = [](const std::string& bytes) {
    std::uint32_t sum = 0xFFFFFFFFU;
    for (const char c : bytes) {
      sum ^= static_cast<unsigned char>(c);
      for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1) != 0 ? 0xEDB88320U : 0);
    }
    return ~sum;
  };
  std::string archive, directory;
  for (const auto& [name, bytes] : files) {
    // Version, flags, method, time and date; then checksum, sizes, and lengths of name and extra.
    const std::string entry = number(20, 2) + number(0, 8) + number(crc(bytes), 4) +
                              number(bytes.size(), 4) + number(bytes.size(), 4) +
                              number(name.size(), 2) + number(0, 2);
    directory += "PK\1\2" + number(20, 2) + entry + number(0, 2) + number(0, 2) + number(0, 2) +
                 number(0, 4) + number(archive.size(), 4) + name;
    archive += "PK\3\4" + entry + name + bytes;
  }
  const std::string end = "PK\5\6" + number(0, 4) + number(files.size(), 2) +
                          number(files.size(), 2) + number(directory.size(), 4) +
                          number(archive.size(), 4) + number(0, 2);
  return archive + directory + end;
}

// Contents of main.xml, and the files beside it.
struct X3pFile {
  std::string feature = "SUR";
  std::string x = "<AxisType>I</AxisType><Increment>1e-6</Increment>";
  std::string y = "<AxisType>I</AxisType><Increment>2e-6</Increment>";
  std::string z = "<AxisType>A</AxisType><DataType>D</DataType>";
  std::string size, data; // inside Record3
  std::map<std::string, std::string> files{};

  static std::string matrix(std::size_t columns, std::size_t rows, std::size_t layers = 1) {
    return "<MatrixDimension><SizeX>" + std::to_string(columns) + "</SizeX><SizeY>" +
           std::to_string(rows) + "</SizeY><SizeZ>" + std::to_string(layers) +
           "</SizeZ></MatrixDimension>";
  }
  static std::string list(std::size_t points) {
    return "<ListDimension>" + std::to_string(points) + "</ListDimension>";
  }
  void setInline(const std::vector<std::string>& points) {
    data = "<DataList>";
    for (const std::string& point : points)
      data += point.empty() ? "<Datum/>" : "<Datum>" + point + "</Datum>";
    data += "</DataList>";
  }
  void setBinary(const std::string& points, const std::string& valid = "") {
    files["bindata/data.bin"] = points;
    data = "<DataLink><PointDataLink>bindata/data.bin</PointDataLink><MD5ChecksumPointData>" +
           md5(points) + "</MD5ChecksumPointData>";
    if (!valid.empty()) {
      files["bindata/valid.bin"] = valid;
      data += "<ValidPointsLink>bindata/valid.bin</ValidPointsLink><MD5ChecksumValidPoints>" +
              md5(valid) + "</MD5ChecksumValidPoints>";
    }
    data += "</DataLink>";
  }
  std::string mainXml() const {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<p:ISO5436_2 "
           "xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\">\n<Record1><Revision>ISO5436 - "
           "2000</Revision><FeatureType>" +
           feature + "</FeatureType><Axes><CX>" + x + "</CX><CY>" + y + "</CY><CZ>" + z +
           "</CZ></Axes></Record1>\n<Record2><Creator>test</Creator></Record2>\n<Record3>" + size +
           data + "</Record3>\n<Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4>\n" +
           "</p:ISO5436_2>\n";
  }
  std::map<std::string, std::string> members() const {
    std::map<std::string, std::string> all = files;
    all["main.xml"] = mainXml();
    all["md5checksum.hex"] = md5(mainXml()) + " *main.xml\n";
    return all;
  }
  std::string bytes() const { return storedZip(members()); }
};

// A surface data file; its numbers are those that Zscale multiplies.
struct SdfFile {
  std::string version = "ISO-1.0";
  std::uint32_t points = 0, profiles = 1;
  double x_scale = 1e-6, y_scale = 2e-6, z_scale = 1e-9;
  int compression = 0, data_type = 7, check_type = 0;

  std::string text(const std::string& heights) const {
    return "a" + version +
           "\r\nManufacID   = test\r\nCreateDate  = 010120261200\r\nModDate     = " +
           "010120261200\r\nNumPoints   = " + std::to_string(points) +
           "\r\nNumProfiles = " + std::to_string(profiles) + "\r\nXscale      = " + of(x_scale) +
           "\r\nYscale      = " + of(y_scale) + "\r\nZscale      = " + of(z_scale) +
           "\r\nZresolution = -1\r\nCompression = " + std::to_string(compression) +
           "\r\nDataType    = " + std::to_string(data_type) +
           "\r\nCheckType   = " + std::to_string(check_type) + "\r\n*\r\n" + heights +
           "\r\n*\r\nOperator = nobody\r\n*\r\n";
  }
  std::string binary(const std::string& heights) const {
    std::string bytes = "b" + version + std::string("test      010120261200010120261200");
    const std::vector<double> counts{static_cast<double>(points), static_cast<double>(profiles)};
    bytes += version == "ISO-2.0" ? bytesOf<std::uint32_t>(counts) : bytesOf<std::uint16_t>(counts);
    bytes += bytesOf<double>({x_scale, y_scale, z_scale, -1});
    for (const int type : {compression, data_type, check_type}) bytes += static_cast<char>(type);
    return bytes + heights;
  }

 private:
  static std::string of(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.14e", value);
    return text;
  }
};

} // namespace patina::test
