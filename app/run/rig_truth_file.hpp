// The truth of bodies with other trees than people's, as cases keep it.
#pragma once

#include "retarget/formats/npz.hpp"
#include "retarget/metrics/rig_truth.hpp"

namespace understudy::app {

/// `vertices` T x V x 3, `joints` T x J x 3, `parents` J, `weights` V x J, `faces` F x 3, `rest` V x 3,
/// `bones` T x J x 12 (from rest: the rotation row by row, the translation) and `axes` J x 3.
Npz rig_truth_arrays(const RigTruth& truth);
/// Whether these are such arrays: they have `parents`.
bool is_rig_truth(const Npz& npz);
/// Throws Error naming the path and what is missing or does not fit.
RigTruth rig_truth_of(const Npz& npz, const std::string& path);

}  // namespace understudy::app
