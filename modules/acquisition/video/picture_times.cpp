#include "acquisition/video/picture_times.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <queue>
#include <string_view>
#include <vector>

extern "C" {
#include <libavformat/avformat.h>
}

namespace patina {
namespace {

// Coders let no more than 16 pictures wait for one that is shown before them.
constexpr std::size_t kWaiting = 32;

} // namespace

// Packets are read and not decoded: each holds a picture.
class PictureTimes::File {
 public:
  explicit File(const std::string& path) {
    if (avformat_open_input(&input_, ("file:" + path).c_str(), nullptr, nullptr) < 0 ||
        avformat_find_stream_info(input_, nullptr) < 0)
      return;
    for (unsigned i = 0; i < input_->nb_streams; ++i) {
      AVStream* stream = input_->streams[i];
      if (stream->codecpar->codec_type == AVMEDIA_TYPE_VIDEO && !stream_)
        stream_ = stream;
      else
        stream->discard = AVDISCARD_ALL;
    }
    packet_ = av_packet_alloc();
    // For a file that is nothing but pictures the reader makes up times, or those of decoding.
    const std::string_view format = input_->iformat->name;
    timed_ = stream_ && packet_ && !(input_->iformat->flags & AVFMT_NOTIMESTAMPS) &&
             !format.ends_with("_pipe");
    is_container_ = !(input_->iformat->flags & AVFMT_GENERIC_INDEX);
  }
  ~File() {
    av_packet_free(&packet_);
    avformat_close_input(&input_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  double next() {
    while (waiting_.size() < kWaiting && readPacket()) {
    }
    if (!timed_ || waiting_.empty()) return NAN;
    const std::int64_t stamp = waiting_.top();
    waiting_.pop();
    if (!first_) first_ = stamp;
    return static_cast<double>(stamp - *first_) * av_q2d(stream_->time_base);
  }
  int held() {
    while (readPacket()) {
    }
    return held_;
  }
  int left() {
    (void)held();
    return static_cast<int>(waiting_.size());
  }

 private:
  // False at the end.
  bool readPacket() {
    if (!stream_ || !packet_) return false;
    for (bool mine = false; !mine; av_packet_unref(packet_)) {
      if (av_read_frame(input_, packet_) < 0) return false;
      mine = packet_->stream_index == stream_->index;
      if (!mine) continue;
      ++held_;
      const bool shown = packet_->pts != AV_NOPTS_VALUE || !is_container_;
      const std::int64_t stamp = shown ? packet_->pts : packet_->dts;
      // Nothing is shown before the first picture that stands for itself.
      if (!key_ && packet_->flags & AV_PKT_FLAG_KEY) key_ = stamp;
      mine = key_ && !(packet_->flags & AV_PKT_FLAG_DISCARD) && stamp >= *key_;
      if (!mine) continue;
      if (stamp == AV_NOPTS_VALUE) timed_ = false;
      waiting_.push(stamp);
    }
    return true;
  }

  AVFormatContext* input_ = nullptr;
  AVStream* stream_ = nullptr;
  AVPacket* packet_ = nullptr;
  bool timed_ = false, is_container_ = false;
  int held_ = 0;
  std::optional<std::int64_t> key_, first_;
  std::priority_queue<std::int64_t, std::vector<std::int64_t>, std::greater<>> waiting_;
};

PictureTimes::PictureTimes(const std::string& path) : file_(std::make_unique<File>(path)) {}

PictureTimes::~PictureTimes() = default;

double PictureTimes::next() {
  return file_->next();
}

int PictureTimes::held() {
  return file_->held();
}

int PictureTimes::left() {
  return file_->left();
}

} // namespace patina
