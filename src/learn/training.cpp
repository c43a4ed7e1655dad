#include "scree/learn/training.hpp"

#include <algorithm>
#include <cassert>
#include <future>

namespace scree {
namespace {

struct Restart {
  Network network;
  TrainingResult result;

  double error() const { return result.curve[result.best].validation_error; }
};

}  // namespace

TrainedNetwork train_network(std::span<const Sample> training, std::span<const Sample> validation,
                             const TrainingSettings& settings) {
  const auto train = [&](std::size_t number) {
    Restart restart{Network(settings.hidden, settings.inputs), {}};
    restart.network.forms = settings.forms;
    fit_normalisation(restart.network, training);
    initialise_weights(restart.network, Random(settings.seed, number));
    restart.result = train_levenberg_marquardt(restart.network, training, validation,
                                               settings.levenberg_marquardt);
    return restart;
  };
  std::vector<std::future<Restart>> others;
  for (std::size_t number = 1; number < settings.restarts; ++number) {
    others.push_back(std::async(std::launch::async, train, number));
  }
  std::vector<Restart> restarts = {train(0)};
  for (std::future<Restart>& other : others) restarts.push_back(other.get());
  std::ranges::stable_sort(restarts, {}, &Restart::error);

  restarts.resize(std::min(restarts.size(), settings.averaged));
  std::vector<Network> networks;
  TrainedNetwork trained;
  for (Restart& restart : restarts) {
    networks.push_back(std::move(restart.network));
    trained.results.push_back(std::move(restart.result));
  }
  trained.network = mean_of(networks);
  return trained;
}

Network mean_of(std::span<const Network> networks) {
  const std::size_t inputs = networks.front().inputs();
  std::size_t hidden = 0;
  for (const Network& network : networks) hidden += network.hidden();
  Network mean(hidden, inputs);
  mean.forms = networks.front().forms;
  mean.mean = networks.front().mean;
  mean.scale = networks.front().scale;

  double* row = mean.weights().data();
  for (const Network& network : networks) {
    assert(network.inputs() == inputs && network.mean == mean.mean && network.scale == mean.scale);
    row = std::ranges::copy(network.weights().first(network.output_row(0)), row).out;
  }
  for (std::size_t output = 0; output < Network::kOutputs; ++output) {
    double& bias = mean.weights()[mean.output_row(output) + hidden];
    for (const Network& network : networks) {
      const auto weights =
          network.weights().subspan(network.output_row(output), network.hidden() + 1);
      const auto share = [&](double weight) {
        return weight / static_cast<double>(networks.size());
      };
      row = std::ranges::transform(weights.first(network.hidden()), row, share).out;
      bias += share(weights.back());
    }
    ++row;
  }
  return mean;
}

}  // namespace scree
