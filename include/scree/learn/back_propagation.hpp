#pragma once

#include <Eigen/Core>
#include <span>

#include "scree/detect/network.hpp"
#include "scree/learn/levenberg_marquardt.hpp"
#include "scree/learn/sample.hpp"

namespace scree {

/// The baseline that the paper's training is held against (fig. 7, 21).
struct BackPropagationSettings {
  double rate = 2.0;      ///< of the gradient of mean_squared_error() in each step
  double momentum = 0;    ///< share of the last step that is taken again, 0..1
  int iterations = 2000;  ///< each over all samples
};

/// d mean_squared_error / dw, an entry for each of weights().
Eigen::VectorXd gradient(const Network& network, std::span<const Sample> samples);

/// Trains in place by gradient descent, w <- w - rate * gradient + momentum * last step, from the
/// weights and the normalisation that the network has. Steps that raise the error are kept, as
/// gradient descent does; the network ends with the weights of the least validation error (training
/// error when `validation` is empty).
TrainingResult train_back_propagation(Network& network, std::span<const Sample> training,
                                      std::span<const Sample> validation,
                                      const BackPropagationSettings& settings = {});

}  // namespace scree
