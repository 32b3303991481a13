// What a blend is made of: kept in documents in place of what comes of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "retarget/base/fields.hpp"

namespace understudy::app {

/// Frames of a motion, both inside.
struct BlendRange {
  int first = 0, last = 0;
};
template <class V, class S>
FieldsOf<S, BlendRange> fields(V& visit, S& range) {
  visit("first", range.first, kFrameNumbers);
  visit("last", range.last, kFrameNumbers);
}

/// A movement that is blended with others.
struct BlendPart {
  std::string path;                   ///< a skeletal motion
  std::optional<BlendRange> range{};  ///< at its own rate; none: its best step (find_steps)
  float weight = 1;                   ///< against those of the others
  std::string checksum{};             ///< of the file (checksum_of_file) when it was chosen; empty: not known
};
template <class V, class S>
FieldsOf<S, BlendPart> fields(V& visit, S& part) {
  visit("path", part.path, FilePath{});
  visit("range", part.range);
  visit("weight", part.weight, Within<float>{0, 1e6f});
  visit("checksum", part.checksum);
}

struct BlendRecipe {
  std::vector<BlendPart> parts;  ///< two to four
  int cycles = 1;                ///< how often the movement is played, one after the other
  std::string coder = "paper";   ///< MotionCoder::name() of what codes them, or "plain"
};
template <class V, class S>
FieldsOf<S, BlendRecipe> fields(V& visit, S& blend) {
  visit("parts", blend.parts);
  visit("cycles", blend.cycles, Within<int>{1, 1000});
  visit("coder", blend.coder);
}

/// "walk.bvh" or "walk.bvh@10:45", with the checksum of the file as it is now. Throws Error naming it: there
/// is no such file, or the range is none.
BlendPart blend_part(const std::string& text);
/// The reverse, by the file's whole path.
std::string in_words(const BlendPart& part);

/// "walk - run": for people, what a blend is called.
std::string name_of(const BlendRecipe& blend);

/// "0.3,0.7". Throws Error where one is no number from 0, or all are 0.
std::vector<float> blend_weights(const std::string& text);
/// Whether both blend the same movements, at whatever weights.
bool are_same_parts(const BlendRecipe& a, const BlendRecipe& b);
/// Gives the parts these weights, made to sum to 1. Throws Error where there are more or fewer.
void set_weights(const std::vector<float>& weights, BlendRecipe& blend);
/// One part's share of the sum, 0..1: the others keep their proportions, or share evenly what is left where
/// they had none. Throws Error where there is no such part.
void set_share(size_t part, float share, BlendRecipe& blend);

}  // namespace understudy::app
