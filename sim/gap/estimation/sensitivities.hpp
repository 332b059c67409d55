#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sim/model/effects/library.hpp"

/// The shapes of an effect that are looked at, and what its sizes change in z around a neutral one.
namespace sim::estimation {

/// The effect as it is and with each value of the parameter that shapes it (speed, time constant); of one that
/// counts periods a turn, with `periods` alone.
std::vector<effects::Placed> shaped(const effects::Placed& neutral,
                                    const std::vector<double>& periods);

/// Indices of the parameters that are sizes, not shapes.
std::vector<std::size_t> sizes_of(const effects::Placed& neutral);

/// Whether a parameter is an amplitude as the effect's first is (a sine beside a cosine); else it is a position, which
/// means nothing without an amplitude.
bool is_like(const effects::Parameter& p, const effects::Parameter& first);

/// One shape, and what a nudge of each size changes in z.
struct Sensitivities {
  effects::Placed shape;
  std::vector<std::size_t> sizes;    ///< indices of parameters
  std::vector<double> perturbation;  ///< in the parameters' units
  Eigen::MatrixXd d;                 ///< one column a size
};

/// What an effect changes in z.
using ChangedBy = std::function<Eigen::VectorXd(const effects::Placed&)>;

/// How far to try to nudge each size.
std::vector<double> first_perturbations(const effects::Placed& neutral,
                                        const std::vector<std::size_t>& sizes);
/// Each size nudged until z changes by about 0.3 % of its noise: as little as for the derivatives by constants
/// (unknowns.hpp), for small differences distinguish one from the other. `by`: how far to try, then how far it was.
Sensitivities sensitivities(const effects::Placed& shape, const std::vector<std::size_t>& sizes,
                            std::vector<double>& by, const ChangedBy& changed_by);
/// Of a law with one size, from 0 on, in which it need not be linear (what gives way, what has play): the change by
/// two larger sizes. Of other laws none, nor of bodies: found so, a bone's flexibility beside a far-off viscous
/// friction imitated a drag that grows with the square of the speed.
std::vector<Sensitivities> secants(const effects::Placed& shape,
                                   const std::vector<std::size_t>& sizes,
                                   const ChangedBy& changed_by);

}  // namespace sim::estimation
