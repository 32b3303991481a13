// A cell of a sheet: 2D poses cut out of their picture, as large as the cell.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "render/pose_picture.hpp"

namespace understudy::render {

struct PoseCell {
  std::vector<FlatPose> others;         ///< people, faint
  std::optional<FlatPose> truth;        ///< grey, below who performs
  std::optional<FlatPose> performer;    ///< in OpenPose's colours
  std::optional<FlatPose> left;         ///< in place of the performer left of a white line through the middle
  std::shared_ptr<const Image> behind;  ///< the picture that they stand in, dimmed; null: black
  bool flagged = false;                 ///< a red bar below
};

/// `view`, pixels of the poses' picture, fills the cell's width; what else the cell holds is of the same
/// scale, `view` in its middle. Throws Error where Image does, and where the view is empty.
Image pose_cell(const PoseCell& cell, const FlatBox& view, int width, int height);

/// Around all points, with a margin; empty where nobody is.
FlatBox view_of(const std::vector<FlatPose>& poses);

}  // namespace understudy::render
