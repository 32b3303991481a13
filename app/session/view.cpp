#include "app/session/view.hpp"

namespace understudy::app {

int pane_count(const View& view, int takes) {
  return view.layout == Layout::SideBySide ? 1 + takes : 1;
}

}  // namespace understudy::app
