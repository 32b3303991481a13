#include "tests/fuzz/stream_reader.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "retarget/base/error.hpp"
#include "retarget/base/rng.hpp"
#include "retarget/live/stream_receiver.hpp"
#include "tests/fuzz/promises.hpp"
#include "tests/support/stream_sender.hpp"

namespace understudy::fuzz {
namespace {

using Pieces = std::vector<std::string_view>;

/// Of a few bytes or of thousands.
Pieces pieces_of(std::string_view bytes, uint8_t choice) {
  Rng rng(choice);
  Pieces pieces;
  for (const int most = 1 << choice % 13; !bytes.empty(); bytes.remove_prefix(pieces.back().size()))
    pieces.push_back(bytes.substr(0, static_cast<size_t>(1 + rng.below(most))));
  return pieces;
}

struct CutStream {
  std::vector<StreamFrame> frames;
  std::string lie;  ///< what ends it
};

CutStream cut_stream(StreamFormat format, const Pieces& pieces) {
  StreamCutter cutter(format);
  CutStream cut;
  try {
    for (std::string_view piece : pieces)
      while (!piece.empty()) {
        const size_t taken = cutter.push(piece);
        must(taken > 0 && taken <= piece.size(), "some bytes are taken");
        piece.remove_prefix(taken);
        if (auto frame = cutter.take()) cut.frames.push_back(std::move(*frame));
      }
  } catch (const Error& error) {
    cut.lie = error.what();
    must(!cut.lie.empty(), "a lie is named");
  }
  return cut;
}

bool same_frames(const CutStream& a, const CutStream& b) {
  return a.lie == b.lie && std::equal(a.frames.begin(), a.frames.end(), b.frames.begin(), b.frames.end(),
                                      [](const StreamFrame& one, const StreamFrame& other) {
                                        return one.format == other.format && one.bytes == other.bytes;
                                      });
}

/// Over a socket to the program's own receiver, which goes on listening for the next input.
void receive(StreamFormat format, const Pieces& pieces, const CutStream& cut) {
  static std::map<StreamFormat, StreamReceiver> all;
  StreamReceiver& receiver =
      all.try_emplace(format, ReceiverOptions{"tcp://127.0.0.1:0", format}).first->second;
  const int64_t before = receiver.dropped();
  const tests::StreamSender sender(receiver.address());
  try {
    for (const std::string_view piece : pieces) sender.send(piece);
  } catch (const Error&) {
    must(!cut.lie.empty(), "who does not lie is not closed");
  }
  sender.end();
  must(sender.heard().empty(), "nobody is refused");
  const auto newest = receiver.newest(StreamReceiver::Moment{});
  const auto came = static_cast<size_t>(receiver.dropped() - before) + (newest ? 1 : 0);
  must(came == cut.frames.size(), "each frame comes");
  must(!newest || newest->frame.bytes == cut.frames.back().bytes, "the newest one is kept");
}

/// As the program takes it for a scan.
void use_frame(const StreamFrame& frame) {
  Mesh mesh = decode(frame, "x");
  check_mesh(mesh);
  must(mesh.vertices.rows() <= kMostStreamPoints, "points are bounded");
  must(!mesh.is_cloud() || finite_count(mesh.vertices) == mesh.vertices.rows(),
       "points of clouds are numbers");
}

}  // namespace

void stream(const std::string& bytes) {
  US_CHECK(bytes.size() > 2, "x: holds no stream");
  const auto form = static_cast<uint8_t>(bytes[0]), choice = static_cast<uint8_t>(bytes[1]);
  const auto format = static_cast<StreamFormat>(form % kStreamFormatNames.size());
  const std::string_view sent = std::string_view(bytes).substr(2);
  const Pieces pieces = pieces_of(sent, choice);
  const CutStream cut = cut_stream(format, pieces);
  must(same_frames(cut, cut_stream(format, {sent})), "pieces make no difference");
  receive(format, pieces, cut);

  std::string problem = cut.lie;
  for (const StreamFrame& frame : cut.frames) try {
      use_frame(frame);
    } catch (const Error& error) {
      problem = error.what();
    }
  US_CHECK(problem.empty(), problem);
}

}  // namespace understudy::fuzz
