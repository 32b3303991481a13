#include "tests/support/display/display.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "retarget/base/error.hpp"

namespace understudy::tests {
namespace {

/// The 32-bit number at `at` of a header of xwd, which is big-endian.
uint32_t header_number(const std::string& bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

}  // namespace

Display::Display(int width, int height) {
  int ends[2];
  if (pipe(ends) != 0) return;
  const std::string folder = memory_.path(".");
  const std::string screen = std::to_string(width) + "x" + std::to_string(height) + "x24";
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    const std::string to = std::to_string(ends[1]);
    execlp("Xvfb", "Xvfb", "-displayfd", to.c_str(), "-screen", "0", screen.c_str(), "-fbdir", folder.c_str(),
           "-nolisten", "tcp", "-noreset", static_cast<char*>(nullptr));
    _exit(127);
  }
  close(ends[1]);
  for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) number_ += c;
  close(ends[0]);
}

Display::~Display() {
  if (pid_ <= 0) return;
  kill(pid_, SIGTERM);
  waitpid(pid_, nullptr, 0);
}

render::Image Display::picture() const {
  const std::string bytes =
      read_bytes(memory_.path("Xvfb_screen0"));  // as xwd writes: header, colours, pixels
  US_CHECK(bytes.size() > 100, memory_.path("Xvfb_screen0"), ": the display cannot be read");
  const size_t header = header_number(bytes, 0), row = header_number(bytes, 48);
  const size_t pixels = header + 12 * static_cast<size_t>(header_number(bytes, 76));
  render::Image image;
  image.width = static_cast<int>(header_number(bytes, 16));
  image.height = static_cast<int>(header_number(bytes, 20));
  US_CHECK(bytes.size() >= pixels + row * static_cast<size_t>(image.height), "the display's picture is cut");
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const size_t from = pixels + static_cast<size_t>(y) * row + 4 * static_cast<size_t>(x);  // B G R -
      for (const size_t channel : {2, 1, 0})
        image.pixels.push_back(static_cast<unsigned char>(bytes[from + channel]));
    }
  return image;
}

}  // namespace understudy::tests
