#include "scree/learn/training.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "unit/learn/stand_in_samples.hpp"

namespace scree {
namespace {

TEST(TrainNetwork, TakesTheBestOfItsRestarts) {
  const auto training = stand_in_samples(3, 300), validation = stand_in_samples(4, 300);
  TrainingSettings settings;
  settings.hidden = 2;
  settings.seed = 1;
  settings.levenberg_marquardt.max_iterations = 12;
  const auto train = [&](std::size_t restarts) {
    settings.restarts = restarts;
    return train_network(training, validation, settings);
  };
  const auto error_of = [](const TrainedNetwork& trained) {
    return trained.result.curve[trained.result.best].validation_error;
  };
  std::vector<double> errors;
  for (std::size_t restarts = 1; restarts <= 6; ++restarts) {
    errors.push_back(error_of(train(restarts)));
  }
  EXPECT_TRUE(std::ranges::is_sorted(errors, std::greater<>()));
  EXPECT_LT(errors.back(), errors.front()) << "another start does better than the first";

  const TrainedNetwork once = train(6), again = train(6);
  EXPECT_TRUE(std::ranges::equal(once.network.weights(), again.network.weights()));
  EXPECT_EQ(error_of(once), errors.back()) << "the weights that go with it";
}

}  // namespace
}  // namespace scree
