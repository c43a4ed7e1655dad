#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scree/learn/levenberg_marquardt.hpp"

namespace scree {

struct TrainingSettings {
  std::size_t hidden = 8;
  std::size_t inputs = kFeatures;  ///< the first of the features; kPaperFeatures: F1-F5
  std::size_t restarts = 5;        ///< from different weights, against local minima
  std::size_t averaged = 1;        ///< the best restarts whose mean is taken, at most all of them
  std::uint64_t seed = 1;          ///< of the first weights
  Network::Forms forms = Network::kDefaultForms;
  LevenbergMarquardtSettings levenberg_marquardt;
};

struct TrainedNetwork {
  Network network;
  std::vector<TrainingResult> results;  ///< of each restart averaged, the best first
};

/// Trains a network from several starts and takes the mean of the settings' `averaged` with the
/// least validation error (training error when `validation` is empty). Inputs are normalised from
/// the training samples alone.
/// @pre averaged >= 1, averaged * hidden <= Network::kMaxHidden
TrainedNetwork train_network(std::span<const Sample> training, std::span<const Sample> validation,
                             const TrainingSettings& settings);

/// One network whose outputs have the mean of the networks' sums: their hidden layers side by side,
/// the weights of the outputs divided by their number.
/// @pre at least one; all normalise the same inputs alike; together no more than kMaxHidden units
Network mean_of(std::span<const Network> networks);

}  // namespace scree
