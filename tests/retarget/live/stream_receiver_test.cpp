// A receiver on this machine: newest wins, one sender at a time, dead and lying ones are survived.
#include "retarget/live/stream_receiver.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>

#include "retarget/base/error.hpp"
#include "tests/support/stream_sender.hpp"

namespace understudy {
namespace {

using Clock = std::chrono::steady_clock;
using tests::StreamSender;

/// One point at so many millimetres.
std::string cloud(int16_t x) {
  std::string bytes(13, '\0');
  bytes[0] = 1;
  std::memcpy(&bytes[4], &x, sizeof x);
  return bytes;
}

class Receiver : public ::testing::Test {
 protected:
  std::optional<float> newest() {
    auto frame = receiver.newest(Clock::now() + std::chrono::seconds(20));
    if (!frame) return {};
    return decode(frame->frame, "test").vertices(0, 0);
  }
  StreamReceiver receiver{{"tcp://127.0.0.1:0", StreamFormat::LiveScan, 1000}};
};

TEST_F(Receiver, HandsOutWhatIsSent) {
  const StreamSender camera(receiver.address());
  camera.send(cloud(1000));
  EXPECT_EQ(newest(), 1.0f);
  camera.send(cloud(2000));
  EXPECT_EQ(newest(), 2.0f);
  EXPECT_EQ(receiver.dropped(), 0);
}

TEST_F(Receiver, KeepsTheNewestAndCountsTheOthers) {
  const StreamSender camera(receiver.address());
  camera.send(cloud(1000) + cloud(2000) + cloud(3000));
  while (receiver.dropped() < 2) usleep(1000);
  EXPECT_EQ(newest(), 3.0f);
}

TEST_F(Receiver, RefusesASecondSenderInASentence) {
  const StreamSender camera(receiver.address());
  camera.send(cloud(1000));
  EXPECT_EQ(newest(), 1.0f);
  const StreamSender second(receiver.address());
  second.send(cloud(3000));  // as cameras do, who wait for nothing
  EXPECT_NE(second.heard().find("is refused"), std::string::npos);
  camera.send(cloud(2000));
  EXPECT_EQ(newest(), 2.0f);
}

TEST_F(Receiver, WaitsForTheNextSenderWhenOneDiesInTheMiddleOfAFrame) {
  {
    const StreamSender camera(receiver.address());
    camera.send(cloud(1000) + cloud(2000).substr(0, 9));
    EXPECT_EQ(newest(), 1.0f);
  }
  const StreamSender again(receiver.address());
  again.send(cloud(3000));
  EXPECT_EQ(newest(), 3.0f);
  EXPECT_FALSE(receiver.ended());
}

TEST_F(Receiver, ClosesWhoLiesAboutALengthAndTakesTheNext) {
  const StreamSender liar(receiver.address());
  liar.send("\xff\xff\xff\x7f and more");
  liar.heard();  // until it is closed
  const StreamSender camera(receiver.address());
  camera.send(cloud(1000));
  EXPECT_EQ(newest(), 1.0f);
}

TEST(StreamReceiver, ASilentSenderMakesRoomForAnother) {
  StreamReceiver receiver({"tcp://127.0.0.1:0", StreamFormat::LiveScan, 0});
  const StreamSender silent(receiver.address()), camera(receiver.address());
  camera.send(cloud(1000));
  EXPECT_TRUE(receiver.newest(Clock::now() + std::chrono::seconds(20)));
}

TEST_F(Receiver, TellsThatAPortIsTaken) {
  try {
    StreamReceiver second({receiver.address()});
    FAIL() << "it listens";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              receiver.address() + ": cannot be listened at (Address already in use)");
  }
}

TEST(StreamReceiver, RefusesAddressesThatAreNone) {
  for (const char* address : {"tcp://127.0.0.1:port", "tcp://127.0.0.1:70000", "udp://127.0.0.1:1"})
    EXPECT_THROW(StreamReceiver({address}), Error) << address;
  EXPECT_EQ(parse_address("tcp://[::1]:80", {"tcp", "", ""}).host, "::1");
  EXPECT_EQ(parse_address("vmc", {"vmc", "127.0.0.1", "39539"}).text(), "vmc://127.0.0.1:39539");
}

}  // namespace
}  // namespace understudy
