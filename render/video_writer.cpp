#include "render/video_writer.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

extern "C" {
#include <libavutil/opt.h>
}

#include "render/libav.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/part_file.hpp"
#include "retarget/base/text.hpp"

namespace understudy::render {

class VideoWriter::Sink {
 public:
  virtual ~Sink() = default;
  virtual void push(const Image& image, int frame) = 0;
  virtual void finish() {}
};

namespace {

namespace fs = std::filesystem;

class Mp4 final : public VideoWriter::Sink {
 public:
  Mp4(std::string path, const VideoOptions& options)
      : path_(std::move(path)), file_(path_), width_(options.width), height_(options.height) {
    av_log_set_level(AV_LOG_FATAL);  // errors have our own sentences
    open_encoder(options);
    open_file();
    open_picture();
  }
  void push(const Image& image, int frame) override {
    check(av_frame_make_writable(picture_.get()), "picture");
    const std::vector<uint8_t> rgb = padded(image);
    const uint8_t* rows[] = {rgb.data()};
    const int strides[] = {3 * encoder_->width};
    sws_scale(scale_.get(), rows, strides, 0, encoder_->height, picture_->data, picture_->linesize);
    picture_->pts = frame;
    encode(picture_.get());
  }

  void finish() override {
    encode(nullptr);
    check(av_write_trailer(format_.get()), "end");
    const int closed = avio_closep(&format_->pb);
    check(closed, "end");
    file_.finish();
  }

 private:
  void check(int code, const char* what) const {
    US_CHECK(code >= 0, path_, ": the film's ", what, " cannot be written, ", words_of(code));
  }

  void open_encoder(const VideoOptions& options) {
    const AVCodec* codec = avcodec_find_encoder_by_name("libx264");
    if (codec == nullptr) codec = avcodec_find_encoder(AV_CODEC_ID_H264);
    US_CHECK(codec != nullptr, path_,
             ": this computer's libavcodec has no H.264 encoder; PNGs can be written instead");
    encoder_.reset(avcodec_alloc_context3(codec));
    encoder_->width = width_ + width_ % 2;
    encoder_->height = height_ + height_ % 2;
    encoder_->pix_fmt = AV_PIX_FMT_YUV420P;  // what every player shows
    encoder_->time_base = av_inv_q(av_d2q(options.fps, 1000000));
    encoder_->framerate = av_inv_q(encoder_->time_base);
    encoder_->color_range = AVCOL_RANGE_MPEG;
    encoder_->colorspace = AVCOL_SPC_BT709;
    encoder_->color_primaries = AVCOL_PRI_BT709;
    encoder_->color_trc = AVCOL_TRC_BT709;
    encoder_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;  // MP4 keeps it apart
    av_opt_set_int(encoder_->priv_data, "crf", options.quality, 0);
    // A fifth of the time of "medium" at the same quality; files are some tenths larger.
    av_opt_set(encoder_->priv_data, "preset", "veryfast", 0);
    if (options.repeatable) {
      encoder_->thread_count = 1;
      // Its AVX-512 code reads memory that nobody has written: bits differ from run to run.
      av_opt_set_int(encoder_->priv_data, "mbtree", 0, 0);
    }
    const int opened = avcodec_open2(encoder_.get(), codec, nullptr);
    US_CHECK(opened >= 0, path_, ": the H.264 encoder takes no ", width_, " x ", height_, " pixels at ",
             options.fps, " frames/s, ", words_of(opened));
  }

  void open_file() {
    AVFormatContext* format = nullptr;
    check(avformat_alloc_output_context2(&format, nullptr, "mp4", file_.part().c_str()), "file");
    format_.reset(format);
    stream_ = avformat_new_stream(format_.get(), nullptr);
    US_CHECK(stream_ != nullptr, path_, ": no memory for a film");
    stream_->time_base = encoder_->time_base;
    stream_->avg_frame_rate = encoder_->framerate;
    check(avcodec_parameters_from_context(stream_->codecpar, encoder_.get()), "format");
    const int opened = avio_open(&format_->pb, file_.part().c_str(), AVIO_FLAG_WRITE);
    US_CHECK(opened >= 0, path_, ": cannot be written, ", words_of(opened));
    AVDictionary* options = nullptr;
    av_dict_set(&options, "movflags", "+faststart", 0);
    const int written = avformat_write_header(format_.get(), &options);
    av_dict_free(&options);
    check(written, "head");
  }

  void open_picture() {
    picture_.reset(av_frame_alloc());
    picture_->format = encoder_->pix_fmt;
    picture_->width = encoder_->width;
    picture_->height = encoder_->height;
    check(av_frame_get_buffer(picture_.get(), 0), "picture");
    packet_.reset(av_packet_alloc());
    scale_.reset(sws_getContext(encoder_->width, encoder_->height, AV_PIX_FMT_RGB24, encoder_->width,
                                encoder_->height, encoder_->pix_fmt, SWS_BICUBIC | SWS_ACCURATE_RND, nullptr,
                                nullptr, nullptr));
    US_CHECK(scale_ != nullptr && packet_ != nullptr, path_, ": no memory for a film");
    sws_setColorspaceDetails(scale_.get(), sws_getCoefficients(SWS_CS_ITU709), 1,
                             sws_getCoefficients(SWS_CS_ITU709), 0, 0, 1 << 16, 1 << 16);
  }

  /// With even sides, over white, and some bytes more: libswscale reads beyond the last row where its width
  /// is no multiple of 16.
  std::vector<uint8_t> padded(const Image& image) const {
    constexpr size_t kBeyond = 64;
    std::vector<uint8_t> pixels;
    if (image.alpha.empty() && width_ == encoder_->width && height_ == encoder_->height) {
      pixels = image.pixels;
    } else {
      Image opaque(width_, height_), even(encoder_->width, encoder_->height);
      paste(opaque, image, 0, 0);
      for (const int dy : {height_ % 2, 0})  // the picture last, over the repeated edges
        for (const int dx : {width_ % 2, 0}) paste(even, opaque, dx, dy);
      pixels = std::move(even.pixels);
    }
    pixels.resize(pixels.size() + kBeyond);
    return pixels;
  }

  /// Hands a picture (null: no more) to the encoder and writes what it gives back.
  void encode(const AVFrame* picture) {
    check(avcodec_send_frame(encoder_.get(), picture), "picture");
    for (;;) {
      const int got = avcodec_receive_packet(encoder_.get(), packet_.get());
      if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return;
      check(got, "picture");
      packet_->duration = 1;
      av_packet_rescale_ts(packet_.get(), encoder_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      check(av_interleaved_write_frame(format_.get(), packet_.get()), "picture");
    }
  }

  std::string path_;
  PartFile file_;
  int width_, height_;
  Owned<AVCodecContext> encoder_;
  Owned<AVFormatContext> format_;
  AVStream* stream_ = nullptr;  // the format's
  Owned<AVFrame> picture_;
  Owned<AVPacket> packet_;
  Owned<SwsContext> scale_;
};

class PngFolder final : public VideoWriter::Sink {
 public:
  explicit PngFolder(std::string path) : path_(std::move(path)) {
    std::error_code why;
    fs::create_directories(path_, why);
    US_CHECK(!why && fs::is_directory(path_), path_, ": is not a folder and cannot be made one");
  }
  void push(const Image& image, int frame) override {
    write_png((fs::path(path_) / printed("frame_%05d.png", frame)).string(), image);
  }

 private:
  std::string path_;
};

}  // namespace

VideoWriter::VideoWriter(const std::string& path, const VideoOptions& options)
    : path_(path), options_(options) {
  US_CHECK(options.width > 0 && options.height > 0 && options.width <= 16384 && options.height <= 16384, path,
           ": a film cannot be ", options.width, " x ", options.height, " pixels");
  US_CHECK(std::isfinite(options.fps) && options.fps >= 1 && options.fps <= 1000, path,
           ": a film cannot have ", options.fps, " frames/s");
  if (file_suffix(path) == ".mp4")
    sink_ = std::make_unique<Mp4>(path, options);
  else
    sink_ = std::make_unique<PngFolder>(path);
}
VideoWriter::~VideoWriter() = default;

void VideoWriter::push(const Image& image) {
  US_CHECK(sink_ != nullptr, path_, ": the film is finished");
  US_CHECK(image.width == options_.width && image.height == options_.height, path_, ": a picture of ",
           image.width, " x ", image.height, " pixels in a film of ", options_.width, " x ", options_.height);
  sink_->push(image, frames_++);
}

void VideoWriter::finish() {
  US_CHECK(sink_ != nullptr, path_, ": the film is finished");
  US_CHECK(frames_ > 0, path_, ": a film without pictures");
  sink_->finish();
  sink_.reset();
}

}  // namespace understudy::render
