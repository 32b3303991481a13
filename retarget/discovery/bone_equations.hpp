// The normal equations of bones: a block for each bone, and for each two that share points or a joint.
#pragma once

#include <Eigen/Core>

namespace understudy {

/// x of `normal` x = `gradient`; normal: symmetric, positive definite. Of a body of many bones, where few
/// blocks are not zero, in time that grows with the bones and not with their cube.
Eigen::VectorXd solved(const Eigen::MatrixXd& normal, const Eigen::VectorXd& gradient);

}  // namespace understudy
