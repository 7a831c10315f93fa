#include "camera/rectifying_rotations.hpp"

namespace flogmap {

RectifyingRotations rectifying_rotations(const Eigen::Isometry3d& right_from_left) {
  const Eigen::AngleAxisd whole(right_from_left.linear());
  const Eigen::Matrix3d half = Eigen::AngleAxisd(whole.angle() / 2, whole.axis()).toRotationMatrix();
  const Eigen::Vector3d left_in_middle = half.transpose() * right_from_left.translation();
  const Eigen::Matrix3d onto_x =
      Eigen::Quaterniond::FromTwoVectors(-left_in_middle, Eigen::Vector3d::UnitX()).toRotationMatrix();
  return {onto_x * half, onto_x * half.transpose()};
}

}  // namespace flogmap
