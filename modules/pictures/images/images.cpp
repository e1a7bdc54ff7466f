#include "pictures/images/images.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <cmath>
#include <cstdint>
#include <exception>
#include <fcntl.h>
#include <limits>
#include <memory>
#include <mutex>
#include <unistd.h>

namespace patina {
namespace {

// OpenEXR's convention is premultiplied colour; files with this attribute are not premultiplied.
constexpr const char* kStraight = "patina:straightAlpha";

std::string oneLine(std::string text) {
  const std::size_t end = text.find('\n');
  if (end != std::string::npos) text.resize(end);
  return text.empty() ? "is no picture that this program can read" : text;
}

std::string refusal(const OIIO::ImageSpec& spec, const ImageLimits& limits) {
  if (spec.deep) return "is a deep image, which this program cannot read";
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
    return "has no flat image";
  if (spec.width > limits.side || spec.height > limits.side) {
    return "has " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
           " texels; at most " + std::to_string(limits.side) + " a side can be read";
  }
  const std::size_t channels = static_cast<std::size_t>(std::min(spec.nchannels, limits.channels));
  const std::size_t texels =
      static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  if (texels * channels > limits.values)
    return "is larger than the memory that is set aside for it";
  return "";
}

// Checks the size that a PNG or an EXR gives itself before memory is set aside for it: deflate
// packs 1032 bytes into one, and a pixel of one bit may stand for four channels of a byte.
bool isTooShort(const OIIO::ImageInput& input, const OIIO::ImageSpec& spec, std::uint64_t bytes) {
  constexpr std::uint64_t kMostExpansion = 1032 * 8 * 4 + 256;
  const std::string format = input.format_name();
  return (format == "png" || format == "openexr") &&
         spec.image_bytes(true) / kMostExpansion > bytes;
}

// `bytes`: size of the file.
std::string readOpened(OIIO::ImageInput& input, const ImageLimits& limits, std::uint64_t bytes,
                       ImageRows& out) {
  const OIIO::ImageSpec spec = input.spec();
  if (std::string cause = refusal(spec, limits); !cause.empty()) return cause;
  if (isTooShort(input, spec, bytes))
    return "is cut off or damaged: " + std::to_string(bytes) + " bytes cannot hold " +
           std::to_string(spec.width) + " x " + std::to_string(spec.height) + " texels";
  out.width = spec.width;
  out.height = spec.height;
  out.channels = std::min(spec.nchannels, limits.channels);
  out.value.assign(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) *
                       static_cast<std::size_t>(out.channels),
                   0.0f);
  if (!input.read_image(0, 0, 0, out.channels, OIIO::TypeFloat, out.value.data()))
    return oneLine(input.geterror());
  const bool alpha = spec.alpha_channel == out.channels - 1 && out.channels % 2 == 0;
  out.premultiplied = alpha && spec.get_int_attribute("oiio:UnassociatedAlpha", 0) == 0 &&
                      spec.get_int_attribute(kStraight, 0) == 0;
  // These formats store EXIF unchanged; readers of others rotate, or the attribute differs.
  const std::string format = input.format_name();
  if (format == "jpeg" || format == "png" || format == "tiff" || format == "webp")
    out.orientation = spec.get_int_attribute("Orientation", 1);
  if (out.orientation < 1 || out.orientation > 8) out.orientation = 1;
  return "";
}

// Silences the error stream, since libpng and others print what they also return. Messages of other
// threads are lost meanwhile.
class Silence {
 public:
  Silence() : guard_(lock()), old_(::dup(STDERR_FILENO)) {
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (old_ >= 0 && nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
    if (nowhere >= 0) ::close(nowhere);
  }
  ~Silence() {
    if (old_ < 0) return;
    ::dup2(old_, STDERR_FILENO);
    ::close(old_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  static std::unique_lock<std::mutex> lock() {
    static std::mutex one;
    return std::unique_lock(one);
  }
  std::unique_lock<std::mutex> guard_;
  int old_;
};

OIIO::ImageSpec specOf(const ImageRows& rows, OIIO::TypeDesc type) {
  OIIO::ImageSpec spec(rows.width, rows.height, rows.channels, type);
  if (rows.channels == 2) spec.channelnames = {"Y", "A"};
  spec.alpha_channel = rows.channels % 2 == 0 ? rows.channels - 1 : -1;
  // A fixed date replaces the current one, so that equal images give equal files.
  spec.attribute("DateTime", "1970:01:01 00:00:00");
  return spec;
}

std::string write(const char* format, const OIIO::ImageSpec& spec, const void* data,
                  std::string& bytes) {
  std::vector<unsigned char> buffer;
  OIIO::Filesystem::IOVecOutput proxy(buffer);
  const auto output = OIIO::ImageOutput::create(format);
  if (!output) return oneLine(OIIO::geterror());
  if (!output->set_ioproxy(&proxy)) return "cannot be written to memory";
  if (!output->open("memory", spec) || !output->write_image(spec.format, data) || !output->close())
    return oneLine(output->geterror());
  bytes.assign(reinterpret_cast<const char*>(buffer.data()), buffer.size());
  return "";
}

// No exception, not even bad_alloc, may leave the library.
template <typename Work> std::string guarded(const Work& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    return oneLine(error.what());
  } catch (...) {
    return oneLine("");
  }
}

std::string readFile(const std::string& path, const ImageLimits& limits, ImageRows& out) {
  return guarded([&]() -> std::string {
    const Silence silence;
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const auto input = OIIO::ImageInput::open(path, &config);
    return input ? readOpened(*input, limits, OIIO::Filesystem::file_size(path), out)
                 : oneLine(OIIO::geterror());
  });
}

std::string readExr(std::string_view bytes, const ImageLimits& limits, ImageRows& out) {
  return guarded([&]() -> std::string {
    OIIO::Filesystem::IOMemReader proxy(bytes.data(), bytes.size());
    const auto input = OIIO::ImageInput::create("exr");
    if (!input) return oneLine(OIIO::geterror());
    OIIO::ImageSpec spec;
    if (!input->set_ioproxy(&proxy)) return "cannot be read from memory";
    return input->open("memory.exr", spec) ? readOpened(*input, limits, bytes.size(), out)
                                           : oneLine(input->geterror());
  });
}

std::string writeExr(const ImageRows& rows, std::string& bytes) {
  return guarded([&] {
    OIIO::ImageSpec spec = specOf(rows, OIIO::TypeFloat);
    // Most images are zeros, which pack well; better compression takes three times as long.
    spec.attribute("compression", "rle");
    spec.attribute(kStraight, 1);
    return write("exr", spec, rows.value.data(), bytes);
  });
}

template <typename Whole>
std::string writePngOf(const ImageRows& rows, const OIIO::TypeDesc& type, std::string& bytes) {
  OIIO::ImageSpec spec = specOf(rows, type);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  // Grey noise hardly compresses; the difference to the row above (PNG's filter "up") is the
  // fastest method with an equal size.
  if (sizeof(Whole) == 1) {
    constexpr int kUp = 0x20;
    spec.attribute("png:compressionLevel", 1);
    spec.attribute("png:filter", kUp);
  }
  constexpr double kMost = std::numeric_limits<Whole>::max();
  std::vector<Whole> data;
  data.reserve(rows.value.size());
  for (const float v : rows.value) {
    const double whole = std::round(static_cast<double>(v) * kMost);
    data.push_back(static_cast<Whole>(whole > 0 ? std::min(whole, kMost) : 0));
  }
  return write("png", spec, data.data(), bytes);
}

std::string writePng(const ImageRows& rows, int bits, std::string& bytes) {
  return guarded([&] {
    return bits == 8 ? writePngOf<std::uint8_t>(rows, OIIO::TypeUInt8, bytes)
                     : writePngOf<std::uint16_t>(rows, OIIO::TypeUInt16, bytes);
  });
}

} // namespace

extern "C" __attribute__((visibility("default"))) const ImageLibrary* patinaImageLibrary() {
  static constexpr ImageLibrary kLibrary{readFile, readExr, writeExr, writePng};
  // Uses no threads of the library while the servo runs.
  static const bool quiet = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1);
  (void)quiet;
  return &kLibrary;
}

} // namespace patina
