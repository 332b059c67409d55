#include "sim/gap/estimation/periods.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <string_view>

#include "sim/gap/residuals/bump.hpp"

namespace sim::estimation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Judged windows of one actuator's gearbox: their indices in z, episodes, and rows in the
/// episodes.
struct Windows {
  std::vector<Index> z_index = {};
  std::vector<std::size_t> episode = {}, row = {};
};

Windows windows_of(const ResidualVector& residuals, const Estimate& base, const std::string& on) {
  Windows windows;
  for (std::size_t b = 0; b < residuals.blocks().size(); ++b) {
    const Block& block = residuals.blocks()[b];
    const std::size_t episode = b / residuals.stages();
    const residuals::Residual& r = residuals.first().residuals[block.stage];
    if (r.stage != effects::Stage::gearbox || r.on != on) continue;
    const auto& rows = base.explained.real[episode].rows;
    for (std::size_t k = 0; k < std::size_t(block.count); ++k) {
      const Index at = block.first + Index(k);
      if (base.z[at] == 0) continue;
      windows.z_index.push_back(at), windows.episode.push_back(episode);
      windows.row.push_back(rows[k]);
    }
  }
  return windows;
}

/// The periodic functions e^(i n φ) of a shaft angle φ at each row, as powers of e^(iφ).
struct Harmonics {
  std::vector<std::complex<double>> once, power;       ///< e^(iφ) and e^(inφ)
  std::vector<std::complex<double>> half, half_power;  ///< the same for half the travel of a period
  std::vector<double> half_travel;
  std::vector<double> sign;  ///< of the speed for friction, otherwise 1

  void next() {
    for (std::size_t k = 0; k < power.size(); ++k) power[k] *= once[k], half_power[k] *= half[k];
  }
  /// Factor by which the mean over a sampling period at row k attenuates n periods per turn:
  /// sin(nφ)/(nφ), φ: half the travel.
  double attenuation(std::size_t k, int n) const {
    const double swept = n * half_travel[k];
    return std::abs(swept) > 1e-6 ? half_power[k].imag() / swept : 1;
  }
};

Harmonics harmonics_of(const residuals::ChainTrace& chain, double turns, bool is_friction,
                       double period_s) {
  Harmonics t;
  for (std::size_t k = 0; k < chain.shaft_rad.size(); ++k) {
    const double omega = chain.speed_rad_per_s[k];
    const double half_travel = turns * omega * period_s / 2;
    t.once.push_back(std::polar(1.0, turns * chain.shaft_rad[k]));
    t.half.push_back(std::polar(1.0, half_travel));
    t.half_travel.push_back(half_travel);
    t.sign.push_back(is_friction ? (omega > 0 ? 1 : -1) : 1);
  }
  t.power.assign(t.once.size(), 1), t.half_power.assign(t.once.size(), 1);
  return t;
}

/// Columns 2n and 2n + 1 of M: cosine and sine of n + 1 periods.
MatrixXd patterns(const Windows& windows, std::size_t actuator, double turns, bool is_friction,
                  const ResidualVector& residuals, const Estimate& base, int max_periods) {
  constexpr double half_width_s = residuals::Windows{}.half_width_s;
  MatrixXd m = MatrixXd::Zero(Index(windows.row.size()), 2 * max_periods);
  std::size_t first = 0;
  while (first < windows.row.size()) {
    const std::size_t episode = windows.episode[first];
    std::size_t last = first;
    while (last < windows.row.size() && windows.episode[last] == episode) ++last;
    const double period_s = residuals.episodes()[episode].period_s;
    const residuals::Bump bump(half_width_s, period_s);
    Harmonics t =
        harmonics_of(*base.explained.real[episode].chains[actuator], turns, is_friction, period_s);
    std::vector<double> cosine(t.once.size()), sine(cosine);
    for (int n = 1; n <= max_periods; ++n) {
      t.next();
      for (std::size_t k = 0; k < sine.size(); ++k) {
        const double size = t.sign[k] * t.attenuation(k, n);
        cosine[k] = size * t.power[k].real(), sine[k] = size * t.power[k].imag();
      }
      for (std::size_t w = first; w < last; ++w) {
        m(Index(w), 2 * n - 2) = bump.mean(cosine, windows.row[w]);
        m(Index(w), 2 * n - 1) = bump.mean(sine, windows.row[w]);
      }
    }
    first = last;
  }
  return m.unaryExpr([](double v) { return std::isnan(v) ? 0.0 : v; });
}

/// The given rows of a sparse matrix.
MatrixXd rows_of(const Eigen::SparseMatrix<double>& j, const std::vector<Index>& rows) {
  std::vector<Index> at(std::size_t(j.rows()), -1);
  for (std::size_t k = 0; k < rows.size(); ++k) at[std::size_t(rows[k])] = Index(k);
  MatrixXd dense = MatrixXd::Zero(Index(rows.size()), j.cols());
  for (Index column = 0; column < j.cols(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator i(j, column); i; ++i)
      if (const Index row = at[std::size_t(i.row())]; row >= 0) dense(row, column) = i.value();
  return dense;
}

}  // namespace

bool counts_periods(const effects::Parameter& p) {
  return std::string_view(p.name) == "periods_per_turn";
}

std::vector<double> periods_of(const effects::Placed& effect, const erp::Robot& robot,
                               const ResidualVector& residuals, const Estimate& base) {
  constexpr std::size_t max_results = 3;  // chosen
  effects::AnyEffect probe = effect.effect;
  const auto parameters = effects::parameters(probe);
  const auto counted = std::ranges::find_if(parameters, counts_periods);
  const Windows windows = windows_of(residuals, base, effect.on);
  if (counted == parameters.end() || windows.row.empty()) return {};

  const bool is_friction = effects::about(effect.effect).stage == effects::Stage::gearbox;
  const auto actuator = std::ranges::find(robot.actuators, effect.on, &erp::Actuator::name);
  const double turns = is_friction ? 1 : robot.motor_of(*actuator).gear_ratio;
  const int max_periods = int(counted->bounds.high);
  const MatrixXd m = patterns(windows, std::size_t(actuator - robot.actuators.begin()), turns,
                              is_friction, residuals, base, max_periods);
  const VectorXd w = base.weight(windows.z_index);
  const MatrixXd j = rows_of(base.jacobian, windows.z_index);
  const VectorXd residual = base.z(windows.z_index) - j * (base.covariance * base.gradient);
  const MatrixXd wm = w.asDiagonal() * m;
  const VectorXd b = wm.transpose() * residual;
  const MatrixXd shared = j.transpose() * wm;

  std::vector<std::pair<double, double>> scored;  // score, periods
  for (int n = 1; n <= max_periods; ++n) {
    const auto two = Eigen::seqN(2 * n - 2, 2);
    const MatrixXd shared_n = shared(Eigen::all, two);
    const Eigen::Matrix2d g = m(Eigen::all, two).transpose() * wm(Eigen::all, two) -
                              shared_n.transpose() * base.covariance * shared_n;
    const Eigen::Vector2d bn = b(two);
    const double score = bn.dot(g.ldlt().solve(bn));
    if (std::isfinite(score)) scored.emplace_back(score, n);
  }
  std::ranges::sort(scored, std::greater());
  std::vector<double> best;
  for (std::size_t k = 0; k < std::min(max_results, scored.size()); ++k)
    best.push_back(scored[k].second);
  return best;
}

}  // namespace sim::estimation
