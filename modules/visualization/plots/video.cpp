#include "visualization/plots/video.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include <unistd.h>

#include <vtkOggTheoraWriter.h>

#include "core/error.h"
#include "visualization/plots/replay_plot.h"
#include "visualization/view/figure_stage.h"

namespace patina {

Figure withEvenSides(Figure figure) {
  figure.width += figure.width % 2;
  figure.height += figure.height % 2;
  return figure;
}

namespace {

int plotWidth(const Figure& figure) {
  return figure.width / 3;
}

Figure besidePlot(Figure figure) {
  figure.width -= plotWidth(figure);
  return figure;
}

// Returns whether a file ends with the last page of an Ogg stream. The writer does not notice a
// full disk.
bool endsAsOgg(const std::filesystem::path& path) {
  constexpr std::size_t kHeader = 27, kLongestPage = kHeader + 255 + 255 * 255; // RFC 3533
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::size_t>(std::max<std::streamoff>(0, file.tellg()));
  std::string end(std::min(size, kLongestPage), '\0');
  file.seekg(static_cast<std::streamoff>(size - end.size()));
  file.read(end.data(), static_cast<std::streamsize>(end.size()));
  const std::size_t page = end.rfind("OggS");
  if (!file || page == std::string::npos || end.size() < page + kHeader) return false;
  const auto byte = [&](std::size_t i) -> std::size_t {
    return i < end.size() ? static_cast<unsigned char>(end[i]) : 0;
  };
  const std::size_t segments = byte(page + 26);
  std::size_t length = kHeader + segments;
  for (std::size_t i = 0; i < segments; ++i) length += byte(page + kHeader + i);
  constexpr std::size_t kEndOfStream = 4;
  return (byte(page + 5) & kEndOfStream) != 0 && page + length == end.size();
}

} // namespace

struct VideoWriter::Impl {
  SceneView& view;
  std::vector<ToolSample> samples;
  std::filesystem::path path, partial; // the same folder
  ReplayPlot plot;
  FigureStage stage;
  vtkNew<vtkOggTheoraWriter> writer;
  int frames = 0, written = 0;
  std::size_t next = 0; // first sample after those shown

  Impl(SceneView& drawn, std::vector<ToolSample> shown, const Figure& figure,
       std::filesystem::path file)
      : view(drawn), samples(std::move(shown)), path(std::move(file)), partial(path),
        plot(samples, {plotWidth(figure), figure.height}, figure.magnification),
        stage(drawn, besidePlot(figure)) {
    partial.replace_filename("." + path.stem().string() + "-" + std::to_string(getpid()) + ".ogv");
    const double seconds = samples.back().t - samples.front().t;
    frames = 1 + static_cast<int>(std::floor(seconds * kVideoFrameRate));
  }
  ~Impl() {
    if (written < frames) writer->End();
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  [[noreturn]] void fail() const {
    throw FileError(path.string(), 0, "cannot be written as a video: no space or no permission");
  }
  void add(vtkImageData* image) {
    writer->SetInputData(image);
    if (written == 0) {
      writer->SetFileName(partial.c_str());
      writer->SetRate(kVideoFrameRate);
      writer->SetQuality(2);
      writer->Start();
    }
    writer->Write();
    if (writer->GetError() != 0) fail();
  }
};

VideoWriter::VideoWriter(SceneView& view, std::vector<ToolSample> samples, Figure figure,
                         const std::filesystem::path& path) {
  if (path.extension() != ".ogv")
    throw Error("a video is an .ogv file, not '" + path.string() + "'");
  if (samples.empty()) throw Error("the recording has no sample: nothing to replay");
  my_ = std::make_unique<Impl>(view, std::move(samples), withEvenSides(std::move(figure)), path);
}

VideoWriter::~VideoWriter() = default;

int VideoWriter::frames() const {
  return my_->frames;
}

int VideoWriter::written() const {
  return my_->written;
}

bool VideoWriter::writeNext() {
  if (my_->written == my_->frames) return false;
  const double time =
      my_->samples.front().t + static_cast<double>(my_->written) / kVideoFrameRate + 1e-9;
  while (my_->next < my_->samples.size() && my_->samples[my_->next].t <= time) ++my_->next;
  const ToolSample& now = my_->samples[std::max<std::size_t>(1, my_->next) - 1];
  my_->view.setTool(now);
  my_->view.prepare();
  my_->add(my_->plot.beside(*my_->stage.draw(), now));
  if (++my_->written < my_->frames) return true;
  my_->writer->End();
  if (!endsAsOgg(my_->partial)) my_->fail();
  std::error_code failed;
  std::filesystem::rename(my_->partial, my_->path, failed);
  if (failed || my_->writer->GetError() != 0) my_->fail();
  return false;
}

} // namespace patina
