// Encodes figures as PNG and TIFF, with the resolution on paper, which VTK's writers leave out.
#include "visualization/view/figure_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <string_view>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>
#include <vtkZLibDataCompressor.h>

#include "core/error.h"
#include "core/file.h"
#include "core/file_kind.h"
#include "visualization/view/figure_stage.h"
#include "visualization/view/vector_figure.h"

namespace patina {
namespace {

bool isPng(const std::filesystem::path& path) {
  return kindOfName(path) == FileKind::png;
}

bool isTiff(const std::filesystem::path& path) {
  return kindOfName(path) == FileKind::tiff;
}

int channelsOf(const FigurePicture& picture) {
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4)
    if (picture.rgba[i] != 255) return 4;
  return 3;
}

std::string_view bytesOf(vtkUnsignedCharArray& array) {
  return {reinterpret_cast<const char*>(array.GetPointer(0)),
          static_cast<std::size_t>(array.GetNumberOfValues())};
}

// Rows from the top with 3 or 4 channels.
std::string samplesOf(const FigurePicture& picture, int channels) {
  std::string samples;
  samples.reserve(picture.rgba.size());
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
    samples.append(reinterpret_cast<const char*>(&picture.rgba[i]),
                   static_cast<std::size_t>(channels));
  return samples;
}

std::string bigEndianBytes(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
  return bytes;
}

// CRC of a PNG chunk (ISO 3309).
std::uint32_t checksum(std::string_view bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc;
}

// A little-endian file of one strip (TIFF 6.0).
class TiffFile {
 public:
  // Words after the header, the entries and the end of the list.
  explicit TiffFile(std::uint16_t entries) : start_(8 + 2 + 12U * entries + 4) {
    list_ = "II*" + std::string(1, '\0');
    append(list_, 8, 4);
    append(list_, entries, 2);
  }
  // Tags must increase. Values that need more than 4 bytes go behind the list.
  void add(std::uint16_t tag, const std::vector<std::uint32_t>& values, int bytes_each = 4) {
    const int type = bytes_each == 2 ? 3 : 4;
    append(list_, tag, 2);
    append(list_, static_cast<std::uint32_t>(type), 2);
    append(list_, static_cast<std::uint32_t>(values.size()), 4);
    if (bytes_each * static_cast<int>(values.size()) > 4) {
      append(list_, start_ + static_cast<std::uint32_t>(data_.size()), 4);
      for (const std::uint32_t value : values) append(data_, value, bytes_each);
    } else {
      append(list_, values.front(), bytes_each);
      list_.append(static_cast<std::size_t>(4 - bytes_each), '\0');
    }
  }
  void addRatio(std::uint16_t tag, double value) {
    append(list_, tag, 2);
    append(list_, 5, 2);
    append(list_, 1, 4);
    append(list_, start_ + static_cast<std::uint32_t>(data_.size()), 4);
    append(data_, static_cast<std::uint32_t>(std::lround(1000 * value)), 4);
    append(data_, 1000, 4);
  }
  // The strip is at the end, after `room` more bytes of values.
  std::uint32_t stripAt(std::uint32_t room) const {
    return start_ + static_cast<std::uint32_t>(data_.size()) + room;
  }
  std::string finished(std::string_view strip) const {
    std::string end;
    append(end, 0, 4);
    return list_ + end + data_ + std::string(strip);
  }

 private:
  static void append(std::string& to, std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) to += static_cast<char>(value >> 8 * i & 255);
  }
  std::uint32_t start_;
  std::string list_, data_;
};

std::string tiffOf(const FigurePicture& picture) {
  const int channels = channelsOf(picture);
  const auto count = static_cast<std::uint32_t>(channels);
  const std::string samples = samplesOf(picture, channels);
  const vtkNew<vtkZLibDataCompressor> zlib;
  const vtkSmartPointer<vtkUnsignedCharArray> strip = vtk::TakeSmartPointer(
      zlib->Compress(reinterpret_cast<const unsigned char*>(samples.data()), samples.size()));
  if (strip == nullptr) throw Error("the figure cannot be encoded as TIFF");
  const bool alpha = channels == 4;
  const bool sized = picture.dpi.has_value();
  TiffFile file(static_cast<std::uint16_t>(10 + (sized ? 3 : 0) + (alpha ? 1 : 0)));
  file.add(256, {static_cast<std::uint32_t>(picture.width)});
  file.add(257, {static_cast<std::uint32_t>(picture.height)});
  file.add(258, std::vector<std::uint32_t>(count, 8), 2);
  file.add(259, {8}, 2); // zlib
  file.add(262, {2}, 2); // RGB
  file.add(273, {file.stripAt(sized ? 16 : 0)});
  file.add(277, {count}, 2);
  file.add(278, {static_cast<std::uint32_t>(picture.height)});
  file.add(279, {static_cast<std::uint32_t>(strip->GetNumberOfValues())});
  if (sized) {
    file.addRatio(282, *picture.dpi);
    file.addRatio(283, *picture.dpi);
  }
  file.add(284, {1}, 2);            // channel fastest
  if (sized) file.add(296, {2}, 2); // per inch
  if (alpha) file.add(338, {2}, 2); // not premultiplied
  return file.finished(bytesOf(*strip));
}

} // namespace

std::string figurePng(const FigurePicture& picture) {
  const int channels = channelsOf(picture);
  const std::string samples = samplesOf(picture, channels);
  const vtkNew<vtkImageData> image;
  image->SetDimensions(picture.width, picture.height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, channels);
  const auto row = static_cast<std::size_t>(channels) * static_cast<std::size_t>(picture.width);
  for (int y = 0; y < picture.height; ++y)
    std::copy_n(samples.begin() + static_cast<std::ptrdiff_t>(row) * y, row,
                static_cast<char*>(image->GetScalarPointer(0, picture.height - 1 - y, 0)));
  const vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  writer->Write();
  if (writer->GetResult() == nullptr) throw Error("the figure cannot be encoded as PNG");
  std::string png(bytesOf(*writer->GetResult()));
  if (!picture.dpi) return png;
  const auto per_metre = static_cast<std::uint32_t>(std::lround(*picture.dpi / 0.0254));
  const std::string chunk = "pHYs" + bigEndianBytes(per_metre) + bigEndianBytes(per_metre) + '\1';
  constexpr std::size_t kAfterHeader = 8 + 25; // signature and IHDR
  return png.insert(kAfterHeader, bigEndianBytes(9) + chunk + bigEndianBytes(checksum(chunk)));
}

bool isFigureFile(const std::filesystem::path& path) {
  return isPng(path) || isTiff(path);
}

void writeFigure(const FigurePicture& picture, const std::filesystem::path& path) {
  if (!isFigureFile(path))
    throw Error("a picture is a .png or .tif file, not '" + path.string() + "'");
  writeFileAtomically(path, isPng(path) ? figurePng(picture) : tiffOf(picture));
}

bool canSaveFigure(const std::filesystem::path& path) {
  return isFigureFile(path) || isVectorFigureFile(path);
}

void saveFigure(SceneView& view, const Figure& figure, const std::filesystem::path& path) {
  if (isVectorFigureFile(path)) return writeVectorFigure(view, figure, path);
  if (!isFigureFile(path))
    throw Error("a picture is a .png, .tif, .svg or .pdf file, not '" + path.string() + "'");
  writeFigure(drawFigure(view, figure), path);
}

} // namespace patina
