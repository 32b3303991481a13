// Corrections of who is who in a source: identities split, joined and exchanged over ranges of frames.
#pragma once

#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/scene/scene.hpp"

namespace understudy {

/// Both frames included.
struct PersonEdit {
  enum class How {
    Exchange,  ///< each has the other's points; with a number that nobody has, somebody is split off
    Join       ///< what is the other's is the person's, too
  };
  How how = How::Exchange;
  int first = 0, last = 0;
  int person = 1, other = 2;  ///< ids, from 1
};
constexpr Names<2> kPersonEditNames{"exchange", "join"};
constexpr Within<int> kPersonIds{1, 99999};
template <class V, class S>
FieldsOf<S, PersonEdit> fields(V& visit, S& edit) {
  visit("how", edit.how, kPersonEditNames);
  visit("first", edit.first, kFrameNumbers);
  visit("last", edit.last, kFrameNumbers);
  visit("person", edit.person, kPersonIds);
  visit("other", edit.other, kPersonIds);
}

/// Who somebody is in a frame after all edits, in their order. Scenery and nobody stay what they are.
int renamed(const std::vector<PersonEdit>& edits, int id, int frame);
/// The same of all that is in the frame. Those who are now one are listed as one.
void apply(const std::vector<PersonEdit>& edits, int frame, SceneFrame& scene);

}  // namespace understudy
