#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sim/model/effects/library.hpp"

/// The shapes of an effect to evaluate, and the sensitivity of z to its sizes at the neutral
/// values. A *shape* parameter (speed, time constant, number of periods) has no effect without a
/// *size*.
namespace sim::estimation {

/// Returns the effect unchanged and with each scanned value of its shape parameter. An effect with
/// a number of periods per turn is returned with `periods` only.
std::vector<effects::Placed> shaped(const effects::Placed& neutral,
                                    const std::vector<double>& periods);

/// Indices of the size parameters.
std::vector<std::size_t> sizes_of(const effects::Placed& neutral);

/// Whether a parameter is an amplitude like the effect's first parameter (for example a sine and a
/// cosine). Otherwise it is a position, which has no effect without an amplitude.
bool is_like(const effects::Parameter& p, const effects::Parameter& first);

/// One shape, and the change of z by a perturbation of each size.
struct Sensitivities {
  effects::Placed shape;
  std::vector<std::size_t> sizes;    ///< indices of parameters
  std::vector<double> perturbation;  ///< in the parameters' units
  Eigen::MatrixXd d;                 ///< one column per size
};

/// Computes the change of z by an effect.
using ChangedBy = std::function<Eigen::VectorXd(const effects::Placed&)>;

/// Initial perturbations of each size.
std::vector<double> first_perturbations(const effects::Placed& neutral,
                                        const std::vector<std::size_t>& sizes);
/// Perturbs each size such that z changes by about 0.3 % of its noise. This is as small as for the
/// derivatives with respect to constants (unknowns.hpp), because small differences distinguish
/// effects from constants. `by`: initial perturbations on input, actual perturbations on output.
Sensitivities sensitivities(const effects::Placed& shape, const std::vector<std::size_t>& sizes,
                            std::vector<double>& by, const ChangedBy& changed_by);
/// The change of z by two larger sizes, for a law with one size from 0 on. The law may be nonlinear
/// in it (compliance, play). Empty for other laws and for bodies: a link's flexibility that was
/// found with large sizes, together with a viscous friction far off, imitated a drag that grows
/// with the square of the speed.
std::vector<Sensitivities> secants(const effects::Placed& shape,
                                   const std::vector<std::size_t>& sizes,
                                   const ChangedBy& changed_by);

}  // namespace sim::estimation
