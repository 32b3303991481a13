#include "retarget/pose2d/lengths_so_far.hpp"

namespace understudy {
namespace {

constexpr int kFewestTelling = 3;  // bones seen: fewer tell little

}  // namespace

const BoneLengths& LengthsSoFar::push(const FlatPose& pose, const LengthReader& reader) {
  if (estimate_.poses() > 0 && (seen_lengths(pose) > 0).count() < kFewestTelling) return lengths_;
  estimate_.push(pose, reader.read(pose));
  if (estimate_.poses() < next_) return lengths_;
  next_ = estimate_.poses() + 1 + estimate_.poses() / 8;
  return lengths_ = estimate_.lengths().length;
}

}  // namespace understudy
