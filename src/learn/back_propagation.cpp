#include "scree/learn/back_propagation.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

using Eigen::VectorXd;

VectorXd gradient(const Network& network, std::span<const Sample> samples) {
  constexpr std::size_t kBlock = 512;  // so that the Jacobian never stands in memory as a whole
  VectorXd sum = VectorXd::Zero(static_cast<Eigen::Index>(network.weights().size()));
  for (std::size_t begin = 0; begin < samples.size(); begin += kBlock) {
    const auto block = samples.subspan(begin, std::min(kBlock, samples.size() - begin));
    const Eigen::MatrixXd j = jacobian(network, block);
    const VectorXd e = errors(network, block);
    for (Eigen::Index w = 0; w < j.cols(); ++w) sum[w] += j.col(w).dot(e);
  }
  const double terms = static_cast<double>(samples.size() * Network::kOutputs);
  return samples.empty() ? sum : VectorXd(2 / terms * sum);
}

TrainingResult train_back_propagation(Network& network, std::span<const Sample> training,
                                      std::span<const Sample> validation,
                                      const BackPropagationSettings& settings) {
  const auto held_out = validation.empty() ? training : validation;
  const auto weights = network.weights();
  std::vector<double> best(weights.begin(), weights.end());
  VectorXd step = VectorXd::Zero(static_cast<Eigen::Index>(weights.size()));
  TrainingResult result;
  result.curve.push_back(
      {mean_squared_error(network, training), mean_squared_error(network, held_out), 0});
  for (int i = 0; i < settings.iterations; ++i) {
    step = settings.momentum * step - settings.rate * gradient(network, training);
    for (std::size_t w = 0; w < weights.size(); ++w) {
      const double moved = weights[w] + step[static_cast<Eigen::Index>(w)];
      weights[w] = std::clamp(moved, -Network::kMaxWeight, Network::kMaxWeight);
    }
    result.curve.push_back(
        {mean_squared_error(network, training), mean_squared_error(network, held_out), 0});
    if (result.curve.back().validation_error >= result.curve[result.best].validation_error)
      continue;
    result.best = result.curve.size() - 1;
    std::ranges::copy(weights, best.begin());
  }
  std::ranges::copy(best, weights.begin());
  return result;
}

}  // namespace scree
