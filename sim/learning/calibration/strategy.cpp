#include "sim/learning/calibration/strategy.hpp"

#include <stdexcept>

#include "sim/learning/calibration/evolution_calibration.hpp"
#include "sim/learning/calibration/newton_calibration.hpp"
#ifdef ERP_WITH_PAGMO
#include "sim/learning/calibration/cma_calibration.hpp"
#endif

namespace sim::calibration {

std::unique_ptr<Calibration> make_calibration(Task task, const StrategyOptions& o) {
  const EvolutionOptions evolution{
      .parents = o.parents, .offspring = o.offspring, .bound = o.bound, .seed = o.seed};
  switch (o.strategy) {
    case Strategy::evolution:
      return std::make_unique<EvolutionCalibration>(std::move(task), evolution);
    case Strategy::newton:
      return std::make_unique<NewtonCalibration>(std::move(task), NewtonOptions{.seed = o.seed});
    case Strategy::cma:
      break;
  }
#ifdef ERP_WITH_PAGMO
  return std::make_unique<CmaCalibration>(std::move(task), evolution);
#else
  throw std::invalid_argument(
      "this erp was built without pagmo; install libpagmo-dev and build it again, or choose "
      "another "
      "strategy");
#endif
}

}  // namespace sim::calibration
