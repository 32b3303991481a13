#include "app/run/bone_search.hpp"

#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {

void check_search(const BoneSearch& search) {
  const MethodChoice& method = rig_method_named(search.method);
  US_CHECK(!method.weights || !search.kind.empty(), "'", method.name,
           "' knows some kinds of bodies: name the one that moves (",
           joined_once({kBodyKinds.begin(), kBodyKinds.end()}), ")");
}

DiscoveryOptions discovery_options(const BoneSearch& search, const KeypointsLoader& load) {
  check_search(search);
  DiscoveryOptions how;
  if (rig_method_named(search.method).weights)
    how.keypoints = load(search.method, search.kind);
  else
    how.parts = search.most;
  return how;
}

}  // namespace understudy::app
