#include "render/video_reader.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/libav.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/file.hpp"

namespace understudy::render {

struct VideoReader::Parts {
  std::string path;
  Owned<AVFormatContext> format;
  Owned<AVCodecContext> decoder;
  Owned<AVPacket> packet;
  Owned<AVFrame> picture, received;
  Owned<SwsContext> scale;
  int stream = 0;
  double fps = 0;

  void check(int code, const char* what) const {
    US_CHECK(code >= 0, path, ": ", what, ", ", words_of(code));
  }
  void open_file() {
    check_file(path);
    AVFormatContext* opened = nullptr;
    check(avformat_open_input(&opened, path.c_str(), nullptr, nullptr), "is not a video");
    format.reset(opened);
    check(avformat_find_stream_info(opened, nullptr), "is not a video");
  }
  void open_decoder() {
    const AVCodec* codec = nullptr;
    stream = av_find_best_stream(format.get(), AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    check(stream, "has no video that can be read");
    const AVStream& video = *format->streams[stream];
    decoder.reset(avcodec_alloc_context3(codec));
    check(avcodec_parameters_to_context(decoder.get(), video.codecpar), "is damaged");
    check(avcodec_open2(decoder.get(), codec, nullptr), "cannot be read");
    fps = av_q2d(video.avg_frame_rate);
    US_CHECK(std::isfinite(fps) && fps > 0, path, ": tells no number of pictures a second");
    US_CHECK(decoder->width > 0 && decoder->height > 0 && decoder->width <= 16384 && decoder->height <= 16384,
             path, ": a video cannot be ", decoder->width, " x ", decoder->height, " pixels");
  }
  /// Hands the decoder the file's next packet of the video; at the end of the file, that there are no more.
  void feed() {
    for (;;) {
      const int read = av_read_frame(format.get(), packet.get());
      if (read == AVERROR_EOF) {
        check(avcodec_send_packet(decoder.get(), nullptr), "is damaged");
        return;
      }
      check(read, "is damaged");
      const bool ours = packet->stream_index == stream;
      const int sent = ours ? avcodec_send_packet(decoder.get(), packet.get()) : 0;
      av_packet_unref(packet.get());
      check(sent, "is damaged");
      if (ours) return;
    }
  }
};

VideoReader::VideoReader(const std::string& path) : parts_(std::make_unique<Parts>()) {
  av_log_set_level(AV_LOG_FATAL);  // errors have our own sentences
  parts_->path = path;
  parts_->open_file();
  parts_->open_decoder();
  parts_->packet.reset(av_packet_alloc());
  parts_->picture.reset(av_frame_alloc());
  parts_->received.reset(av_frame_alloc());
  US_CHECK(parts_->packet != nullptr && parts_->picture != nullptr && parts_->received != nullptr, path,
           ": no memory for a video");
}
VideoReader::~VideoReader() = default;
VideoReader::VideoReader(VideoReader&&) noexcept = default;
VideoReader& VideoReader::operator=(VideoReader&&) noexcept = default;

int VideoReader::width() const {
  return parts_->decoder->width;
}
int VideoReader::height() const {
  return parts_->decoder->height;
}
double VideoReader::fps() const {
  return parts_->fps;
}

bool VideoReader::next() {
  for (;;) {
    const int got = avcodec_receive_frame(parts_->decoder.get(), parts_->received.get());
    if (got == AVERROR_EOF) return false;
    if (got != AVERROR(EAGAIN)) {
      parts_->check(got, "is damaged");
      av_frame_unref(parts_->picture.get());
      av_frame_move_ref(parts_->picture.get(), parts_->received.get());
      return true;
    }
    parts_->feed();
  }
}

Image VideoReader::picture() {
  const AVFrame& from = *parts_->picture;
  US_CHECK(from.width == width() && from.height == height(), parts_->path,
           ": its pictures change their size");
  if (parts_->scale == nullptr) {
    parts_->scale.reset(sws_getContext(width(), height(), static_cast<AVPixelFormat>(from.format), width(),
                                       height(), AV_PIX_FMT_RGB24, SWS_BILINEAR, nullptr, nullptr, nullptr));
    US_CHECK(parts_->scale != nullptr, parts_->path, ": its colours cannot be read");
    sws_setColorspaceDetails(parts_->scale.get(), sws_getCoefficients(SWS_CS_ITU709), 0,
                             sws_getCoefficients(SWS_CS_ITU709), 1, 0, 1 << 16, 1 << 16);
  }
  // libswscale writes some pixels more than a row has where its width is no multiple of 16.
  const size_t row = 3 * static_cast<size_t>(width()), stride = (row + 127) / 64 * 64;
  std::vector<uint8_t> padded(stride * static_cast<size_t>(height()));
  uint8_t* rows[] = {padded.data()};
  const int strides[] = {static_cast<int>(stride)};
  sws_scale(parts_->scale.get(), from.data, from.linesize, 0, height(), rows, strides);
  Image image(width(), height());
  for (int y = 0; y < height(); ++y)
    std::copy_n(padded.data() + static_cast<size_t>(y) * stride, row, image.at(0, y));
  return image;
}

void VideoReader::restart() {
  parts_->check(av_seek_frame(parts_->format.get(), parts_->stream, 0, AVSEEK_FLAG_BACKWARD), "is damaged");
  avcodec_flush_buffers(parts_->decoder.get());
}

}  // namespace understudy::render
