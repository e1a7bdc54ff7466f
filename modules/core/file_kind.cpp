#include "core/file_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sstream>
#include <sys/stat.h>

#include "core/descriptor.h"
#include "core/disk_error.h"
#include "core/numbers.h"
#include "core/utf8.h"

namespace patina {
namespace {

constexpr std::size_t kHead = 1024;

std::string_view firstLine(std::string_view text) {
  std::string_view line = text.substr(0, text.find('\n'));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string_view afterFirstLine(std::string_view text) {
  const std::size_t end = text.find('\n');
  return end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
}

bool isNumber(std::string_view cell) {
  return parseNumber(std::string(cell)).has_value();
}

// A header of names: one contains a unit, unless a row with as many numbers follows.
bool isTable(std::string_view text) {
  const std::string_view header = firstLine(text);
  if (header.find(',') == std::string_view::npos || header.find_first_of("{}<>\t") != header.npos)
    return false;
  const std::string_view rest = afterFirstLine(text);
  const std::string_view row = firstLine(rest);
  const bool whole = rest.find('\n') != std::string_view::npos; // the head may cut the row
  if (!whole) return header.find(" [") != std::string_view::npos;
  return std::count(row.begin(), row.end(), ',') == std::count(header.begin(), header.end(), ',') &&
         isNumber(row.substr(0, row.find(',')));
}

bool isObj(std::string_view text) {
  for (; !text.empty(); text = afterFirstLine(text)) {
    const std::string_view line = firstLine(text);
    if (line.empty() || line.starts_with('#')) continue;
    const std::array<std::string_view, 8> words = {"v ", "vn ", "vt ",     "f ",
                                                   "o ", "g ",  "mtllib ", "usemtl "};
    return std::any_of(words.begin(), words.end(),
                       [&](std::string_view word) { return line.starts_with(word); });
  }
  return false;
}

// Lines of eight numbers after comments, or the header comment that this program writes.
bool isPoses(std::string_view text) {
  for (; !text.empty(); text = afterFirstLine(text)) {
    const std::string_view line = firstLine(text);
    if (line.starts_with("# t [s] tx ty tz")) return true;
    if (line.empty() || line.starts_with('#')) continue;
    std::istringstream cells{std::string(line)};
    int numbers = 0;
    for (std::string cell; cells >> cell; ++numbers)
      if (!isNumber(cell)) return false;
    return numbers >= 8;
  }
  return false;
}

bool isBinaryStl(std::string_view head, std::uint64_t size) {
  constexpr std::size_t kHeader = 80, kTriangle = 50;
  if (head.size() < kHeader + 4) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, head.data() + kHeader, sizeof count);
  return size == kHeader + 4 + kTriangle * std::uint64_t{count};
}

} // namespace

FileKind kindOf(std::string_view head, std::uint64_t size) {
  using namespace std::string_view_literals;
  if (size == 0) return FileKind::empty;
  head = head.substr(0, kHead);
  if (isBinaryStl(head, size)) return FileKind::stl;
  if (head.starts_with("\x89PNG"sv)) return FileKind::png;
  if (head.starts_with("%PDF"sv)) return FileKind::pdf;
  if (head.starts_with("II*\0"sv) || head.starts_with("MM\0*"sv)) return FileKind::tiff;
  if (head.size() > 2 && head[0] == 'P' && head[1] >= '1' && head[1] <= '6' && head[2] <= ' ')
    return FileKind::pnm;
  if (head.starts_with(".TH ")) return FileKind::roff;
  if (head.starts_with("\x76\x2f\x31\x01"sv)) return FileKind::exr;
  head = withoutByteOrderMark(head);
  if (head.starts_with("ply\n"sv) || head.starts_with("ply\r"sv)) return FileKind::ply;
  if (head.starts_with("solid"sv) && head.find("facet") != head.npos) return FileKind::stl;
  if (head.starts_with("%YAML"sv)) return FileKind::yaml;
  if (head.find("<svg") != head.npos) return FileKind::svg;
  if (head.find("<VTKFile") != head.npos) {
    if (head.find("\"ImageData\"") != head.npos) return FileKind::image_data;
    if (head.find("\"PolyData\"") != head.npos) return FileKind::poly_data;
    return FileKind::other;
  }
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  if (first != head.npos && (head[first] == '{' || head[first] == '[')) return FileKind::json;
  if (isTable(head)) return FileKind::table;
  if (isPoses(head)) return FileKind::poses;
  return isObj(head) ? FileKind::obj : FileKind::other;
}

std::string_view nameOf(FileKind kind) {
  constexpr std::array<std::string_view, 18> names = {
      "an empty file", "a table",        "a JSON file",    "an OBJ mesh",
      "a PLY mesh",    "an STL mesh",    "a .vti volume",  "a .vtp surface",
      "a PNG picture", "a TIFF picture", "an SVG drawing", "a PDF document", "an EXR picture", "a YAML file",
      "a PNM picture", "poses",          "a manual page",  "a file of another kind"};
  return names[static_cast<std::size_t>(kind)];
}

std::optional<FileKind> kindOfName(const std::filesystem::path& path) {
  struct Ending {
    std::string_view text;
    FileKind kind;
  };
  constexpr std::array<Ending, 18> endings = {{{".csv", FileKind::table},
                                               {".json", FileKind::json},
                                               {".obj", FileKind::obj},
                                               {".ply", FileKind::ply},
                                               {".stl", FileKind::stl},
                                               {".vti", FileKind::image_data},
                                               {".vtp", FileKind::poly_data},
                                               {".png", FileKind::png},
                                               {".tif", FileKind::tiff},
                                               {".tiff", FileKind::tiff},
                                               {".svg", FileKind::svg},
                                               {".pdf", FileKind::pdf},
                                               {".exr", FileKind::exr},
                                               {".yaml", FileKind::yaml},
                                               {".yml", FileKind::yaml},
                                               {".pgm", FileKind::pnm},
                                               {".ppm", FileKind::pnm},
                                               {".tum", FileKind::poses}}};
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const Ending& one : endings)
    if (one.text == ending) return one.kind;
  return std::nullopt;
}

namespace {

// Returns the kind of an existing readable file; absent if it is missing or empty.
std::optional<FileKind> kindOfFile(const std::string& name) {
  struct stat info {};
  if (::stat(name.c_str(), &info) != 0 || !S_ISREG(info.st_mode) || info.st_size == 0) return {};
  const Descriptor file(openRetrying(name.c_str(), O_RDONLY));
  if (file.get() < 0 && errno == EACCES) return {}; // write-only file
  if (file.get() < 0) throw DiskError(name, "cannot be opened: " + reason(errno));
  std::array<char, kHead> buffer{};
  const std::size_t got = readSome(file.get(), name, buffer.data(), buffer.size());
  return kindOf(std::string_view(buffer.data(), got), static_cast<std::uint64_t>(info.st_size));
}

} // namespace

void requireSameKind(const std::filesystem::path& path, FileKind kind) {
  const std::string name = path.string();
  const bool nameless = kind == FileKind::other || kind == FileKind::empty;
  if (const std::optional<FileKind> old = kindOfFile(name); old && (nameless || *old != kind))
    throw FileError(name, 0,
                    "is " + std::string(nameOf(*old)) + ", and is not overwritten by " +
                        (kind == FileKind::other ? "another" : std::string(nameOf(kind))) +
                        "; remove it or choose another name");
  if (nameless) return;
  if (const std::optional<FileKind> expected = kindOfName(path); expected && *expected != kind)
    throw FileError(name, 0,
                    "is the name of " + std::string(nameOf(*expected)) + ", but " +
                        std::string(nameOf(kind)) + " is to be written");
}

} // namespace patina
