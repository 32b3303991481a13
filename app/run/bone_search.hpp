// How bones of anything are looked for: what a document, a command line and both bodies share.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "retarget/base/fields.hpp"
#include "retarget/discovery/discover.hpp"
#include "retarget/pipeline/method_table.hpp"

namespace understudy::app {

constexpr int kMostBones = 300;  ///< that may be asked for

struct BoneSearch {
  int most = 0;  ///< bones at most; 0: as many as the motion shows, and by methods with a network
  std::string method = rig_methods().front().name;  ///< one of rig_methods()
  std::string kind{};  ///< of the body, one of kBodyKinds, where the method has a network
};
template <class V, class S>
FieldsOf<S, BoneSearch> fields(V& visit, S& search) {
  visit("most", search.most, Within<int>{0, kMostBones});
  visit("method", search.method);
  visit("kind", search.kind);
}

/// What finds the keypoints of a kind by a method that has a network. Throws Error (see
/// nn::load_keypoint_finder).
using KeypointsLoader =
    std::function<std::shared_ptr<KeypointFinder>(const std::string& method, const std::string& kind)>;

/// Throws Error where the method is not known, or is told no kind though it needs one.
void check_search(const BoneSearch& search);
/// As discover() has it, its network loaded where the method has one; without progress. Throws Error as
/// check_search() and the loader do.
DiscoveryOptions discovery_options(const BoneSearch& search, const KeypointsLoader& load);

}  // namespace understudy::app
