#include "sim/learning/experience/base_file.hpp"

#include <algorithm>
#include <stdexcept>

#include "sim/model/skeleton/pose.hpp"

namespace sim::experience {
namespace {

void expect(bool is_valid, const xml::Place& place, const std::string& what) {
  if (!is_valid)
    throw std::invalid_argument(place.file + ":" + std::to_string(place.line) + ": " + what);
}

std::string count_mismatch(std::size_t actual, std::ptrdiff_t expected, const std::string& items) {
  return std::to_string(actual) + " numbers, but there are " + std::to_string(expected) + " " +
         items;
}

}  // namespace

Base base_of(const BaseFile& file) {
  std::vector<Experience> experiences;
  for (const ExperienceRow& row : file.experiences.all)
    experiences.push_back(
        {row.start,
         Eigen::Map<const Eigen::VectorXd>(row.scales_Vs.data(), std::ssize(row.scales_Vs)),
         vec(row.end_m)});
  return {std::ssize(file.drives.all), std::move(experiences)};
}

std::vector<ExperienceRow> rows_of(const Base& base) {
  std::vector<ExperienceRow> rows;
  for (const Experience& experience : base.all())
    rows.push_back({{},
                    experience.start,
                    {experience.scales_Vs.begin(), experience.scales_Vs.end()},
                    numbers(experience.end_m)});
  return rows;
}

void check(const BaseFile& file, Eigen::Index muscles) {
  matrix_of(file.drives.all, muscles);
  Patterns{file.bursts.all};
  expect(!file.drives.all.empty() && !file.starts.all.empty(), file.place,
         "an <experience_base> has at least one <drive> and one <start>");
  for (const StartRow& start : file.starts.all)
    expect(std::ssize(start.line_m) == muscles, start.place,
           count_mismatch(start.line_m.size(), muscles, "muscles; use the base of this robot"));
  for (const ExperienceRow& row : file.experiences.all) {
    expect(row.scales_Vs.size() == file.drives.all.size(), row.place,
           count_mismatch(row.scales_Vs.size(), std::ssize(file.drives.all), "drives"));
    expect(row.start < std::ssize(file.starts.all), row.place,
           "start " + std::to_string(row.start) + ", but there are " +
               std::to_string(file.starts.all.size()) + ", counted from 0");
  }
}

Reach reach_with(const BaseFile& file, int start, const Eigen::Vector3d& target_m,
                 const Eigen::VectorXd& scales_Vs, std::shared_ptr<const Feedback> feedback) {
  const auto& line_m = file.starts.all[static_cast<std::size_t>(start)].line_m;
  const auto muscles = std::ssize(line_m);
  return {Patterns(file.bursts.all),
          matrix_of(file.drives.all, muscles),
          file.times,
          {Eigen::Map<const Eigen::VectorXd>(line_m.data(), muscles), scales_Vs, target_m,
           std::move(feedback)}};
}

double peak_V(const BaseFile& file, const Eigen::VectorXd& scales_Vs) {
  constexpr double sample_s = 0.01;  // chosen
  const Patterns patterns(file.bursts.all);
  const Eigen::MatrixXd drives =
      matrix_of(file.drives.all, std::ssize(file.starts.all.front().line_m));
  double peak = 0;
  for (double t = 0; t < patterns.end_s(); t += sample_s)
    peak = std::max(peak, voltages_V(patterns, drives, scales_Vs, t).cwiseAbs().maxCoeff());
  return peak;
}

/// Voltages are proportional to a common factor of the scales: one division suffices.
Eigen::VectorXd within_voltage(const BaseFile& file, const Eigen::VectorXd& scales_Vs) {
  const double peak = peak_V(file, scales_Vs);
  return peak > file.pattern_V ? Eigen::VectorXd(scales_Vs * (file.pattern_V / peak)) : scales_Vs;
}

}  // namespace sim::experience
