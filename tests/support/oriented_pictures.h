// Picture files with an orientation, made without the library that reads them.
#pragma once

#include <filesystem>
#include <string>

#include <opencv2/videoio.hpp>

#include "acquisition/values/orientation.h"
#include "core/file.h"
#include "support/fresh_folder.h"

namespace patina::test {

// Returns the picture to store so that it is shown as `shown` at this EXIF orientation.
inline GreyFrame storedAs(const GreyFrame& shown, int orientation) {
  // Quarter turns undo one another, the other six themselves.
  GreyFrame stored = turned(shown, orientation == 6 ? 8 : orientation == 8 ? 6 : orientation);
  stored.orientation = 1;
  return stored;
}

// The `bytes` low bytes of a number, the lowest first.
inline std::string littleEndian(std::uint64_t number, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(number >> 8 * i & 0xff);
  return text;
}

// The directory of a TIFF file: entries of one number each, at byte 8.
inline std::string tiffHead(const std::vector<std::pair<int, int>>& entries) {
  std::string text = std::string("II*\0\x08\0\0\0", 8) + littleEndian(entries.size(), 2);
  for (const auto& [tag, value] : entries)
    text += littleEndian(static_cast<std::uint64_t>(tag), 2) + littleEndian(4, 2) +
            littleEndian(1, 4) + littleEndian(static_cast<std::uint64_t>(value), 4);
  return text + littleEndian(0, 4);
}

inline void writeTiff(const std::filesystem::path& path, const GreyFrame& image, int orientation) {
  const int head = 8 + 2 + 11 * 12 + 4, size = image.width * image.height;
  writeFileAtomically(path, tiffHead({{256, image.width},
                                      {257, image.height},
                                      {258, 8},
                                      {259, 1},
                                      {262, 1},
                                      {273, head},
                                      {274, orientation},
                                      {277, 1},
                                      {278, image.height},
                                      {279, size},
                                      {284, 1}}) +
                                std::string(image.pixel.begin(), image.pixel.end()));
}

// The picture of a Motion JPEG video, which carries whole JPEG files.
inline std::string jpegOf(const GreyFrame& image) {
  const std::filesystem::path folder = freshFolder("jpeg");
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "one.avi").string();
  {
    cv::VideoWriter writer(path, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25,
                           {image.width, image.height}, false);
    writer.write(
        cv::Mat(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.row(0))));
  }
  const std::string bytes = readFile(path);
  std::filesystem::remove_all(folder);
  const std::size_t begin = bytes.find("\xff\xd8\xff"), end = bytes.rfind("\xff\xd9");
  return begin == std::string::npos || end == std::string::npos
             ? std::string()
             : bytes.substr(begin, end + 2 - begin);
}

// Writes EXIF's orientation like a phone's camera.
inline void writeJpeg(const std::filesystem::path& path, const GreyFrame& image, int orientation) {
  const std::string jpeg = jpegOf(image);
  std::string exif = std::string("Exif\0\0", 6) + std::string("II*\0\x08\0\0\0\x01\0", 10) +
                     littleEndian(274, 2) + littleEndian(3, 2) + littleEndian(1, 4) +
                     littleEndian(static_cast<std::uint64_t>(orientation), 4) + littleEndian(0, 4);
  const std::size_t size = exif.size() + 2;
  writeFileAtomically(path, jpeg.substr(0, 2) + "\xff\xe1" + static_cast<char>(size >> 8) +
                                static_cast<char>(size & 0xff) + exif + jpeg.substr(2));
}

} // namespace patina::test
