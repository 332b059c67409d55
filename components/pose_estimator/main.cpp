#include "components/pose_estimator/pose_estimator.hpp"

int main(int argc, char** argv) { return node::run<pose::PoseEstimator>(argc, argv); }
