#include "scree/learn/training.hpp"

#include <algorithm>
#include <future>
#include <vector>

namespace scree {

TrainedNetwork train_network(std::span<const Sample> training, std::span<const Sample> validation,
                             const TrainingSettings& settings) {
  const auto error_of = [](const TrainedNetwork& trained) {
    return trained.result.curve[trained.result.best].validation_error;
  };
  const auto train = [&](std::size_t restart) {
    TrainedNetwork trained{Network(settings.hidden, settings.inputs), {}};
    trained.network.forms = settings.forms;
    fit_normalisation(trained.network, training);
    initialise_weights(trained.network, Random(settings.seed, restart));
    trained.result = train_levenberg_marquardt(trained.network, training, validation,
                                               settings.levenberg_marquardt);
    return trained;
  };
  std::vector<std::future<TrainedNetwork>> others;
  for (std::size_t restart = 1; restart < settings.restarts; ++restart) {
    others.push_back(std::async(std::launch::async, train, restart));
  }
  TrainedNetwork best = train(0);
  for (std::future<TrainedNetwork>& other : others) {
    TrainedNetwork trained = other.get();
    if (error_of(trained) < error_of(best)) best = std::move(trained);
  }
  return best;
}

}  // namespace scree
