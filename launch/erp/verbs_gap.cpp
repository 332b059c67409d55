#include <iostream>
#include <memory>

#include "launch/erp/gap.hpp"
#include "launch/erp/verbs.hpp"

namespace launch {

void add_gap(CLI::App& app, Chosen& chosen) {
  auto* gap = app.add_subcommand("gap", "Where a robot and its model part");
  gap->require_subcommand(1);
  auto robot = std::make_shared<std::string>();
  auto recordings = std::make_shared<std::vector<std::string>>();
  auto* where = gap->add_subcommand(
      "where", "Which stages of the chain recordings contradict: motor, gearbox, tendon, joint");
  where->add_option("--robot", *robot, "robot.xml, the model")->required();
  where->add_option("--real", *recordings, "recordings of the robot, MCAP or CSV")->required();
  where->callback([=, &chosen] {
    chosen = [=] { return gap_where(*robot, *recordings, std::cout, std::cerr); };
  });
}

}  // namespace launch
