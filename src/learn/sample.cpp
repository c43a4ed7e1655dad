#include "scree/learn/sample.hpp"

#include <cmath>

namespace scree {

void fit_normalisation(Network& network, std::span<const Sample> samples) {
  network.mean.fill(0);
  network.scale.fill(1);
  if (samples.empty()) return;
  const auto count = static_cast<double>(samples.size());
  for (std::size_t i = 0; i < network.inputs(); ++i) {
    double sum = 0;
    for (const Sample& sample : samples) sum += apply(network.forms[i], sample.features[i]);
    const double mean = sum / count;
    double squares = 0;
    for (const Sample& sample : samples) {
      const double off = apply(network.forms[i], sample.features[i]) - mean;
      squares += off * off;
    }
    constexpr double kLeastScale = 1e-6;
    const double deviation = std::sqrt(squares / count);
    network.mean[i] = mean;
    network.scale[i] = deviation > kLeastScale ? deviation : 1;
  }
}

void initialise_weights(Network& network, Random random) {
  const std::span<double> weights = network.weights();
  const std::size_t first_output = network.output_row(0);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const std::size_t inputs = i < first_output ? network.inputs() : network.hidden();
    const double reach = 2.0 / std::sqrt(static_cast<double>(inputs + 1));
    weights[i] = random.uniform(-reach, reach);
  }
}

}  // namespace scree
