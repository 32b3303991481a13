// What a document says of 2D poses: how the source's are read and put right, and of a take who performs them.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "retarget/base/fields.hpp"
#include "retarget/pipeline/method_table.hpp"
#include "retarget/pose2d/flat_placement.hpp"

namespace understudy::app {

/// Of a source that is 2D poses, beside its SourceOptions.
struct FlatSource {
  bool ahead = true;  ///< proportions are read off the whole file before its first frame
};
template <class V, class S>
FieldsOf<S, FlatSource> fields(V& visit, S& flat) {
  visit("ahead", flat.ahead);
}

/// A bone's length as the user wants it.
struct ChosenLength {
  std::string bone;     ///< name of one of kFlatBones
  float pixels = 1;     ///< of the reference's picture
  bool locked = false;  ///< stays when the other side or the whole size is changed
};
constexpr Within<float> kBonePixels{0.1f, 65536};
template <class V, class S>
FieldsOf<S, ChosenLength> fields(V& visit, S& chosen) {
  visit("bone", chosen.bone);
  visit("pixels", chosen.pixels, kBonePixels);
  visit("locked", chosen.locked);
}

/// Of a take whose target is a person in a picture.
struct FlatTake {
  std::string engine = flat_engines().front().name;
  FlatPlace place = FlatPlace::Reference;
  bool touches = true;                ///< hands that touch keep touching
  bool growth = true;                 ///< who comes nearer grows
  std::string person;                 ///< who of the target's file, a number; empty: who is seen longest
  std::string canvas;                 ///< of the target's picture, "1280x720"; empty: as its file tells
  std::vector<ChosenLength> lengths;  ///< over those that are read off the picture; one a bone
};
template <class V, class S>
FieldsOf<S, FlatTake> fields(V& visit, S& flat) {
  visit("engine", flat.engine);
  visit("place", flat.place, kFlatPlaceNames);
  visit("touches", flat.touches);
  visit("growth", flat.growth);
  visit("person", flat.person);
  visit("canvas", flat.canvas);
  visit("lengths", flat.lengths);
}

/// Null: it is as read.
inline const ChosenLength* chosen_length(const FlatTake& take, const std::string& bone) {
  const auto found = std::find_if(take.lengths.begin(), take.lengths.end(),
                                  [&](const ChosenLength& one) { return one.bone == bone; });
  return found == take.lengths.end() ? nullptr : &*found;
}

}  // namespace understudy::app
