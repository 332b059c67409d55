#include "sim/learning/experience/drives.hpp"

#include "sim/model/actuator/musculoskeletal.hpp"

namespace sim::experience {
namespace {

Drive drive(const std::string& name, const Eigen::VectorXd& shortening) {
  const double largest = shortening.cwiseAbs().maxCoeff();
  Drive drive{.name = name, .shares = {shortening.begin(), shortening.end()}};
  if (largest > 0)
    for (double& muscle_share : drive.shares)
      muscle_share = muscle_share == 0 ? 0 : muscle_share / largest;
  return drive;
}

}  // namespace

std::vector<Drive> drives_of(const erp::Robot& robot) {
  Musculoskeletal model(robot);
  std::vector<JointReading> start;
  for (const erp::Joint& joint : model.tree().joints) start.push_back(initial_reading(joint));
  model.place(start);
  std::vector<Drive> drives;
  for (std::size_t j = 0; j < start.size(); ++j) {
    const int count = coordinates_of(start[j].type), first = model.skeleton().first_of(int(j));
    for (int k = 0; k < count && first >= 0; ++k)
      drives.push_back(
          drive(model.tree().joints[j].name + (count > 1 ? std::string(".") + "xyzuvw"[k] : ""),
                -model.jacobian().col(first + k)));
  }
  return drives;
}

}  // namespace sim::experience
