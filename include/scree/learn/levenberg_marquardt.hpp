#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>
#include <vector>

#include "scree/detect/network.hpp"
#include "scree/learn/sample.hpp"

namespace scree {

struct LevenbergMarquardtSettings {
  double damping = 0.01;       ///< u at the start
  double damping_factor = 10;  ///< u is divided by it after a good step, multiplied after a bad one
  double max_damping = 1e10;   ///< beyond it no step lowers the error: the end
  int max_iterations = 300;
  double least_gain = 1e-7;  ///< relative fall of the error that still counts as one
  int patience = 15;         ///< steps without such a fall, or without a better validation error
};

enum class StopReason { iterations, converged, validation, damping };
std::string_view name_of(StopReason reason);

/// After each step: mean of (t - o)^2 over samples and outputs, and u.
struct TrainingStep {
  double training_error = 0;
  double validation_error = 0;
  double damping = 0;
};

struct TrainingResult {
  std::vector<TrainingStep> curve;  ///< its first entry is the start
  std::size_t best = 0;             ///< entry whose weights the network now has
  StopReason stop = StopReason::iterations;
};

/// Errors e = t - o of all samples: row 2 s + k is output k of sample s.
Eigen::VectorXd errors(const Network& network, std::span<const Sample> samples);
/// J = de/dw, a row for each entry of errors(), a column for each of weights() (paper eq. 12).
Eigen::MatrixXd jacobian(const Network& network, std::span<const Sample> samples);
/// Mean of e^2; 0 for no samples.
double mean_squared_error(const Network& network, std::span<const Sample> samples);

/// Trains in place by w <- w - (J^T J + u I)^-1 J^T e (paper eq. 15, fig. 6), from the weights and
/// the normalisation that the network has. A step that does not lower the error is taken back.
/// Keeps the weights with the least validation error (training error when `validation` is empty).
TrainingResult train_levenberg_marquardt(Network& network, std::span<const Sample> training,
                                         std::span<const Sample> validation,
                                         const LevenbergMarquardtSettings& settings = {});

}  // namespace scree
