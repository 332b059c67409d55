#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sim/model/effects/library.hpp"

/// The shapes of an effect that are tried, and the sensitivity of z to its sizes around the neutral values.
namespace sim::estimation {

/// The effect as it is and with each value of the parameter that shapes it (speed, time constant); for an effect with a
/// number of periods per turn, with `periods` only.
std::vector<effects::Placed> shaped(const effects::Placed& neutral,
                                    const std::vector<double>& periods);

/// Indices of the parameters that are sizes, not shapes.
std::vector<std::size_t> sizes_of(const effects::Placed& neutral);

/// Whether a parameter is an amplitude like the effect's first (a sine and a cosine). Otherwise it is a position, which
/// has no meaning without an amplitude.
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
/// Perturbs each size until z changes by about 0.3 % of its noise. This is as small as for the derivatives with respect
/// to constants (unknowns.hpp), for small differences distinguish effects from constants. `by`: initial perturbations
/// on input, actual ones on output.
Sensitivities sensitivities(const effects::Placed& shape, const std::vector<std::size_t>& sizes,
                            std::vector<double>& by, const ChangedBy& changed_by);
/// For a law with one size, from 0 on, in which it may be nonlinear (compliance, play): the change by two larger sizes.
/// Empty for other laws and for bodies: found this way, a link's flexibility with a far-off viscous friction imitated a
/// drag that grows with the square of the speed.
std::vector<Sensitivities> secants(const effects::Placed& shape,
                                   const std::vector<std::size_t>& sizes,
                                   const ChangedBy& changed_by);

}  // namespace sim::estimation
