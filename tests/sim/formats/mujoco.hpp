#pragma once
#include <mujoco/mujoco.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

#include "sim/formats/formats.hpp"

/// A robot loaded into MuJoCo from the exported MJCF, as a reference implementation.
namespace reference {

class Mujoco {
 public:
  explicit Mujoco(const erp::Robot& robot) {
    const auto file = std::filesystem::temp_directory_path() /
                      ("erp_" + std::to_string(getpid()) + "_" + robot.name + ".xml");
    std::ofstream(file) << formats::to_mjcf(robot);
    char error[500] = "";
    model.reset(mj_loadXML(file.c_str(), nullptr, error, sizeof error));
    std::filesystem::remove(file);
    if (!model) throw std::runtime_error(error);
    data.reset(mj_makeData(model.get()));
    mj_resetDataKeyframe(model.get(), data.get(), 0);
    mj_forward(model.get(), data.get());
  }
  double* position_of(const std::string& joint) const {
    return data->qpos + model->jnt_qposadr[mj_name2id(model.get(), mjOBJ_JOINT, joint.c_str())];
  }
  double length_m(const std::string& tendon) const {
    return data->ten_length[mj_name2id(model.get(), mjOBJ_TENDON, tendon.c_str())];
  }

  struct Delete {
    void operator()(mjModel* m) const { mj_deleteModel(m); }
    void operator()(mjData* d) const { mj_deleteData(d); }
  };
  std::unique_ptr<mjModel, Delete> model;
  std::unique_ptr<mjData, Delete> data;
};

}  // namespace reference
