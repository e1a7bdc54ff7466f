#include "acquisition/files/frame_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "acquisition/files/measured.h"
#include "acquisition/values/orientation.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "pictures/picture_file.h"
#include "scene/scene_scan.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kFrameColumns = {"frame", "t [s]"};

// Returns true for a picture's name; the file is a damaged frame if it cannot be decoded.
bool isNamedAsPicture(const std::string& name) {
  std::string extension = name.substr(std::min(name.rfind('.'), name.size()));
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const char* known : {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".pgm", ".webp"})
    if (extension == known) return true;
  return false;
}

// Returns true for the other files of a scan, which may be in the folder of the pictures.
bool isOfScan(const std::string& name) {
  return std::any_of(kScanFiles.begin(), kScanFiles.end(),
                     [&](const ScanFile& file) { return file.name == name; });
}

// Compares names with their digits as numbers: IMG_9 comes before IMG_10.
bool isBefore(const std::string& a, const std::string& b) {
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!isDigit(a[i]) || !isDigit(b[j])) {
      if (a[i] != b[j]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
      ++i, ++j;
      continue;
    }
    while (i < a.size() && a[i] == '0') ++i;
    while (j < b.size() && b[j] == '0') ++j;
    const std::size_t first = i, second = j;
    while (i < a.size() && isDigit(a[i])) ++i;
    while (j < b.size() && isDigit(b[j])) ++j;
    if (i - first != j - second) return i - first < j - second;
    if (const int order = a.compare(first, i - first, b, second, j - second); order != 0)
      return order < 0;
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;
}

std::vector<fs::path> picturesIn(const fs::path& folder, std::string* left_out) {
  std::vector<fs::path> files, others;
  std::error_code code;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end;
       entry.increment(code)) {
    const std::string name = entry->path().filename().string();
    std::error_code none;
    if (entry->is_directory(none) || isOfScan(name)) continue;
    const bool hidden = name[0] == '.';
    const bool picture = !hidden && (isPictureByContent(entry->path()) || isNamedAsPicture(name));
    (picture ? files : others).push_back(entry->path());
  }
  const auto byName = [](const fs::path& a, const fs::path& b) {
    return isBefore(a.filename().string(), b.filename().string());
  };
  std::sort(files.begin(), files.end(), byName);
  if (left_out && !others.empty()) {
    const fs::path first = *std::min_element(others.begin(), others.end(), byName);
    *left_out =
        folder.string() + ": " + formatCount(others.size()) +
        (others.size() == 1 ? " file is no picture and is" : " files are no pictures and are") +
        " left out: " + first.filename().string() + (others.size() > 1 ? ", ..." : "");
  }
  return files;
}

} // namespace

GreyFrame readGrey(const fs::path& path) {
  const Picture picture = readPicture(path);
  GreyFrame image{picture.width, picture.height, {}};
  image.pixel.reserve(index(image.width) * index(image.height));
  const int channels = picture.channels;
  for (int y = picture.height - 1; y >= 0; --y) {
    const float* texel = picture.texel.data() + index(y) * index(picture.width * channels);
    for (int x = 0; x < picture.width; ++x, texel += channels) {
      const float grey =
          channels < 3 ? texel[0] : 0.299f * texel[0] + 0.587f * texel[1] + 0.114f * texel[2];
      image.pixel.push_back(static_cast<std::uint8_t>(255 * std::clamp(grey, 0.f, 1.f) + 0.5f));
    }
  }
  return turned(std::move(image), picture.orientation);
}

void writeGrey(const fs::path& path, const GreyFrame& image) {
  Picture picture{image.width, image.height, 1, {}};
  picture.texel.reserve(image.pixel.size());
  for (int y = image.height - 1; y >= 0; --y)
    for (int x = 0; x < image.width; ++x)
      picture.texel.push_back(static_cast<float>(image.row(y)[x]) / 255);
  writePicture(path, picture, 8);
}

std::vector<Frame> framesOf(const fs::path& folder, double rate, std::string* left_out) {
  std::error_code code;
  if (!fs::is_directory(folder, code)) throw FileError(folder.string(), 0, "is not a folder");
  const bool inner = fs::is_directory(folder / "frames", code);
  const std::vector<fs::path> files = picturesIn(inner ? folder / "frames" : folder, left_out);
  std::vector<Frame> frames;
  const fs::path list = folder / "frames.csv";
  if (!fs::exists(list, code)) {
    if (files.empty())
      throw FileError(folder.string(), 0, "there is neither frames.csv nor a picture");
    if (!(rate > 0))
      throw FileError(list.string(), 0,
                      "is missing, so say how many frames there are a second: --rate");
    for (const fs::path& file : files)
      frames.push_back({static_cast<double>(frames.size()) / rate, file});
    return frames;
  }
  std::map<std::string, fs::path> by_number;
  for (const fs::path& file : files) by_number.emplace(file.stem().string(), file);
  for (const FrameRow& row : parseFrameList(readFile(list), list.string())) {
    const auto file = by_number.find(frameStem(row.number));
    frames.push_back({row.t, file != by_number.end()
                                 ? file->second
                                 : folder / "frames" / (frameStem(row.number) + ".png")});
  }
  return frames;
}

std::vector<FrameRow> parseFrameList(const std::string& text, const std::string& name) {
  CsvReader reader(sourceOfText(text), name, {kFrameColumns});
  std::vector<FrameRow> rows;
  std::map<int, std::size_t> line_of;
  for (std::vector<double> row; reader.next(row);) {
    if (!(row[0] >= 0 && row[0] < 1e9 && row[0] == std::floor(row[0])))
      throw FileError(name, reader.line(), "a frame's number must be whole and not negative");
    requireMeasured(row[1], "t [s]", name, reader.line());
    if (!rows.empty() && !(row[1] > rows.back().t))
      throw FileError(name, reader.line(),
                      row[1] == rows.back().t ? "time repeats" : "time runs backwards");
    const int number = static_cast<int>(row[0]);
    if (const auto [before, is_new] = line_of.emplace(number, reader.line()); !is_new)
      throw FileError(name, reader.line(),
                      "frame " + std::to_string(number) + " stands in line " +
                          std::to_string(before->second) + " already");
    rows.push_back({number, row[1]});
  }
  if (rows.empty()) throw FileError(name, 0, "there is no frame in it");
  return rows;
}

std::string frameStem(int number) {
  char stem[16];
  std::snprintf(stem, sizeof stem, "%06d", number);
  return stem;
}

std::string frameListHeader() {
  return csvHeader(kFrameColumns);
}

} // namespace patina
