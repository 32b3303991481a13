// A receiver on this machine: newest wins, one sender at a time, dead and lying ones are survived.
#include "retarget/live/stream_receiver.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

using Clock = std::chrono::steady_clock;

/// Connects to a receiver.
class Sender {
 public:
  explicit Sender(const StreamReceiver& receiver) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const std::string& address = receiver.address();
    place.sin_port = htons(static_cast<uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
    EXPECT_EQ(connect(socket_.value(), reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
  }
  void send(const std::string& bytes) const {
    EXPECT_EQ(::send(socket_.value(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  /// What is said to it until it is closed.
  std::string heard() const {
    timeval patience{20, 0};
    setsockopt(socket_.value(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    std::string all;
    char buffer[256];
    for (ssize_t n; (n = read(socket_.value(), buffer, sizeof buffer)) > 0;) all.append(buffer, n);
    return all;
  }

 private:
  Descriptor socket_;
};

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
  const Sender camera(receiver);
  camera.send(cloud(1000));
  EXPECT_EQ(newest(), 1.0f);
  camera.send(cloud(2000));
  EXPECT_EQ(newest(), 2.0f);
  EXPECT_EQ(receiver.dropped(), 0);
}

TEST_F(Receiver, KeepsTheNewestAndCountsTheOthers) {
  const Sender camera(receiver);
  camera.send(cloud(1000) + cloud(2000) + cloud(3000));
  while (receiver.dropped() < 2) usleep(1000);
  EXPECT_EQ(newest(), 3.0f);
}

TEST_F(Receiver, RefusesASecondSenderInASentence) {
  const Sender camera(receiver);
  camera.send(cloud(1000));
  EXPECT_EQ(newest(), 1.0f);
  EXPECT_NE(Sender(receiver).heard().find("is refused"), std::string::npos);
  camera.send(cloud(2000));
  EXPECT_EQ(newest(), 2.0f);
}

TEST_F(Receiver, WaitsForTheNextSenderWhenOneDiesInTheMiddleOfAFrame) {
  {
    const Sender camera(receiver);
    camera.send(cloud(1000) + cloud(2000).substr(0, 9));
    EXPECT_EQ(newest(), 1.0f);
  }
  const Sender again(receiver);
  again.send(cloud(3000));
  EXPECT_EQ(newest(), 3.0f);
  EXPECT_FALSE(receiver.ended());
}

TEST_F(Receiver, ClosesWhoLiesAboutALengthAndTakesTheNext) {
  const Sender liar(receiver);
  liar.send("\xff\xff\xff\x7f and more");
  liar.heard();  // until it is closed
  const Sender camera(receiver);
  camera.send(cloud(1000));
  EXPECT_EQ(newest(), 1.0f);
}

TEST(StreamReceiver, ASilentSenderMakesRoomForAnother) {
  StreamReceiver receiver({"tcp://127.0.0.1:0", StreamFormat::LiveScan, 0});
  const Sender silent(receiver), camera(receiver);
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
