#include "acquisition/files/frame_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <sstream>

#include "acquisition/files/measured.h"
#include "core/csv_rows.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "pictures/picture_file.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kFrameColumns = {"frame", "t [s]"};

// Numbers of a key with the line where it stands.
struct Entry {
  std::vector<double> numbers;
  std::size_t line = 0;
};

// What of OpenCV's YAML a camera needs: `key: number`, and matrices' `data: [numbers]` under
// theirs.
std::map<std::string, Entry> entriesIn(const std::string& whole, const std::string& name) {
  std::istringstream text(whole);
  std::map<std::string, Entry> entries;
  std::string key;
  bool listing = false;
  std::size_t number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    if (line.ends_with('\r')) line.pop_back();
    std::string rest = line;
    if (!listing) {
      const std::size_t colon = line.find(':');
      if (line.empty() || line[0] == '%' || line[0] == '#' || colon == std::string::npos) continue;
      const std::size_t first = line.find_first_not_of(' ');
      const std::string word = line.substr(first, colon - first);
      rest = line.substr(colon + 1);
      if (first == 0) key = word;
      if (word == "data") {
        listing = rest.find('[') != std::string::npos;
        if (!listing) throw FileError(name, number, "'data' must be a list in [ ]");
        rest = rest.substr(rest.find('[') + 1);
        entries[key] = {{}, number};
      } else if (first > 0 || rest.find("!!") != std::string::npos) {
        continue;
      } else {
        if (const auto value =
                parseNumber(rest.substr(std::min(rest.find_first_not_of(' '), rest.size()))))
          entries[key] = {{*value}, number};
        continue;
      }
    }
    const std::size_t end = rest.find(']');
    std::string words = rest.substr(0, end);
    std::replace(words.begin(), words.end(), ',', ' ');
    std::istringstream list(words);
    for (std::string word; list >> word;) {
      if (word.back() == '.') word.pop_back(); // as OpenCV writes whole numbers
      const auto value = parseNumber(word);
      if (!value || !std::isfinite(*value))
        throw FileError(name, number, "'" + word.substr(0, 40) + "' is not a finite number");
      entries[key].numbers.push_back(*value);
    }
    listing = end == std::string::npos;
  }
  return entries;
}

bool isPicture(const fs::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg" ||
         extension == ".tif" || extension == ".tiff" || extension == ".bmp" || extension == ".pgm";
}

std::vector<fs::path> picturesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code code;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end;
       entry.increment(code))
    if (isPicture(entry->path())) files.push_back(entry->path());
  std::sort(files.begin(), files.end());
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
      image.pixel.push_back(
          static_cast<std::uint8_t>(std::lround(255 * std::clamp(grey, 0.f, 1.f))));
    }
  }
  return image;
}

void writeGrey(const fs::path& path, const GreyFrame& image) {
  Picture picture{image.width, image.height, 1, {}};
  picture.texel.reserve(image.pixel.size());
  for (int y = image.height - 1; y >= 0; --y)
    for (int x = 0; x < image.width; ++x)
      picture.texel.push_back(static_cast<float>(image.row(y)[x]) / 255);
  writePicture(path, picture, 8);
}

Camera readCamera(const fs::path& path) {
  return parseCamera(readFile(path), path.string());
}

Camera parseCamera(const std::string& text, const std::string& name) {
  const auto entries = entriesIn(text, name);
  const auto entry = [&](const std::string& key, std::size_t least,
                         std::size_t most) -> const Entry& {
    const auto found = entries.find(key);
    if (found == entries.end()) throw FileError(name, 0, "'" + key + "' is missing");
    const std::size_t count = found->second.numbers.size();
    if (count < least || count > most)
      throw FileError(name, found->second.line,
                      "'" + key + "' has " + std::to_string(count) + " numbers");
    return found->second;
  };
  const auto side = [&](const std::string& key) {
    const Entry& found = entry(key, 1, 1);
    const double value = found.numbers[0];
    if (!(value >= 1 && value <= 16384 && value == std::floor(value)))
      throw FileError(name, found.line, "'" + key + "' must be a whole number up to 16384");
    return static_cast<int>(value);
  };
  Camera camera;
  camera.width = side("image_width");
  camera.height = side("image_height");
  const Entry& matrix = entry("camera_matrix", 9, 9);
  const std::vector<double>& m = matrix.numbers;
  if (!(m[0] > 0 && m[4] > 0) || m[1] != 0 || m[3] != 0 || m[6] != 0 || m[7] != 0 || m[8] != 1)
    throw FileError(name, matrix.line, "'camera_matrix' must be fx 0 cx 0 fy cy 0 0 1");
  camera.fx = m[0], camera.cx = m[2], camera.fy = m[4], camera.cy = m[5];
  const Entry& lens = entry("distortion_coefficients", 0, 5);
  std::copy(lens.numbers.begin(), lens.numbers.end(), camera.distortion.begin());
  return camera;
}

std::string cameraText(const Camera& camera, const std::string& more) {
  const auto list = [](const std::vector<double>& numbers) {
    std::string text;
    for (const double number : numbers) text += (text.empty() ? "" : ", ") + formatNumber(number);
    return "   dt: d\n   data: [ " + text + " ]\n";
  };
  return "%YAML:1.0\n---\nimage_width: " + std::to_string(camera.width) +
         "\nimage_height: " + std::to_string(camera.height) +
         "\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n" +
         list({camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1}) +
         "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n" +
         list({camera.distortion.begin(), camera.distortion.end()}) + more;
}

std::vector<Frame> framesOf(const fs::path& folder, double rate) {
  std::error_code code;
  if (!fs::is_directory(folder, code)) throw FileError(folder.string(), 0, "is not a folder");
  const bool inner = fs::is_directory(folder / "frames", code);
  const std::vector<fs::path> files = picturesIn(inner ? folder / "frames" : folder);
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
  CsvReader reader(sourceOfText(text), name, kFrameColumns);
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
