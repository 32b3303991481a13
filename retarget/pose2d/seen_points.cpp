#include "retarget/pose2d/seen_points.hpp"

#include "retarget/base/error.hpp"

namespace understudy {

SeenPoints seen_points(const FlatPose& seen, int least, const std::string& otherwise) {
  SeenPoints found;
  found.pose = seen;
  add_middles(found.pose);
  int points = 0;
  for (int p = 0; p < kPaperPoints; ++p)
    if (found.pose.has(p)) found.box.extend(found.pose.at(p)), ++points;
  US_CHECK(points >= least, "a pose of ", points, " points ", otherwise, ": it needs ", least);
  US_CHECK(found.pose.body.topRows(kPaperPoints).allFinite(), "a pose has points that are not finite");
  return found;
}

}  // namespace understudy
