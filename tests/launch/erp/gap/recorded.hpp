#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "interfaces/recording/csv.hpp"
#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/rigs.hpp"

inline const std::string rig_file = rigs::config("hinge_rig/robot.xml");

/// A folder of recordings of the rig, without a gap or with Coulomb friction in a gearbox.
struct RecordedRig {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("erp_rig_" + std::to_string(::getpid()));
  RecordedRig() { std::filesystem::create_directories(path); }
  ~RecordedRig() { std::filesystem::remove_all(path); }

  std::string result(const char* file) const { return path / "found" / file; }
  std::string read(const char* file) const {
    std::ifstream in(result(file));
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::string recorded(const std::string& name, bool friction, std::uint64_t seed,
                       double seconds = 5) const {
    erp::Robot robot = erp::read_robot(rig_file);
    if (friction) robot.effects = {{{}, "gearbox_coulomb", "extensor", {{{}, "extra_Nm", "0.03"}}}};
    rig_recording::Plan plan{.seconds = seconds, .seed = seed};
    plan.swing_Hz += 0.1 * double(seed);
    std::ofstream out(path / name);
    recording::write_csv(rig_recording::table_of_run(robot, plan), out);
    return path / name;
  }
};

/// Multiplies a column of a recording by a factor.
inline void scale_column(const std::string& file, const std::string& name, double factor) {
  recording::Table table = recording::read_table(file);
  for (auto& column : table.columns)
    if (column.name == name)
      for (double& value : column.values) value *= factor;
  std::ofstream out(file);
  recording::write_csv(table, out);
}
