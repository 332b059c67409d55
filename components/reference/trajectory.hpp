#pragma once
#include <string>
#include <vector>

#include "interfaces/values.hpp"

/// A trajectory file: CSV with `time_s` and, per actuator, `<a>.mode` and `<a>.reference`. Values
/// are interpolated linearly between rows. Before the first and after the last row the value is
/// constant.
namespace reference {

class Trajectory {
 public:
  struct Column {
    std::string actuator;
    std::vector<double> time_s, value;  ///< without empty cells
    std::vector<erp::Mode> mode;
    double at(double t_s) const;
    erp::Mode mode_at(double t_s) const;

   private:
    std::size_t row_before(double t_s) const;
  };

  Trajectory() = default;
  /// Throws std::invalid_argument with place, value and remedy.
  explicit Trajectory(const std::string& file);
  const std::vector<Column>& columns() const { return columns_; }
  double duration_s() const { return duration_s_; }

 private:
  std::vector<Column> columns_;
  double duration_s_ = 0;
};

}  // namespace reference
