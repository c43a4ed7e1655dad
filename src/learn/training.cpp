#include "scree/learn/training.hpp"

#include <algorithm>
#include <optional>

namespace scree {

TrainedNetwork train_network(std::span<const Sample> training, std::span<const Sample> validation,
                             const TrainingSettings& settings) {
  const auto error_of = [](const TrainedNetwork& trained) {
    return trained.result.curve[trained.result.best].validation_error;
  };
  std::optional<TrainedNetwork> best;
  for (std::size_t i = 0; i < std::max<std::size_t>(settings.restarts, 1); ++i) {
    TrainedNetwork trained{Network(settings.hidden, settings.inputs), {}};
    trained.network.forms = settings.forms;
    fit_normalisation(trained.network, training);
    initialise_weights(trained.network, Random(settings.seed, i));
    trained.result = train_levenberg_marquardt(trained.network, training, validation,
                                               settings.levenberg_marquardt);
    if (!best || error_of(trained) < error_of(*best)) best = std::move(trained);
  }
  return *std::move(best);
}

}  // namespace scree
