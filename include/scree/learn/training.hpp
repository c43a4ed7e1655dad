#pragma once

#include <cstdint>
#include <span>

#include "scree/learn/levenberg_marquardt.hpp"

namespace scree {

struct TrainingSettings {
  std::size_t hidden = 8;
  std::size_t inputs = kFeatures;  ///< the first of the features; kPaperFeatures: F1-F5
  std::size_t restarts = 5;        ///< from different weights, against local minima
  std::uint64_t seed = 1;          ///< of the first weights
  Network::Forms forms = Network::kDefaultForms;
  LevenbergMarquardtSettings levenberg_marquardt;
};

struct TrainedNetwork {
  Network network;
  TrainingResult result;
};

/// Trains a network from several starts; the one with the least validation error wins (training
/// error when `validation` is empty). Inputs are normalised from the training samples alone.
TrainedNetwork train_network(std::span<const Sample> training, std::span<const Sample> validation,
                             const TrainingSettings& settings);

}  // namespace scree
