#include "scree/learn/training.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "unit/learn/stand_in_samples.hpp"

namespace scree {
namespace {

TrainingSettings short_training(std::size_t restarts) {
  TrainingSettings settings;
  settings.hidden = 2;
  settings.inputs = kPaperFeatures;  // all that the stand-ins have
  settings.seed = 1;
  settings.restarts = restarts;
  settings.levenberg_marquardt.max_iterations = 12;
  return settings;
}

double error_of(const TrainingResult& result) {
  return result.curve[result.best].validation_error;
}

/// The sums that the outputs' sigmoids take.
Network::Outputs sums(const Network& network, const Features& features) {
  std::array<double, Network::kMaxHidden> hidden;
  Network::Outputs outputs = network.forward(network.normalised(features), hidden);
  for (double& output : outputs) output = std::log(output / (1 - output));
  return outputs;
}

TEST(TrainNetwork, TakesTheBestOfItsRestarts) {
  const auto training = stand_in_samples(3, 300), validation = stand_in_samples(4, 300);
  const auto train = [&](std::size_t restarts) {
    return train_network(training, validation, short_training(restarts));
  };
  std::vector<double> errors;
  for (std::size_t restarts = 1; restarts <= 6; ++restarts) {
    const TrainedNetwork trained = train(restarts);
    ASSERT_EQ(trained.results.size(), 1U);
    errors.push_back(error_of(trained.results[0]));
  }
  EXPECT_TRUE(std::ranges::is_sorted(errors, std::greater<>()));
  EXPECT_LT(errors.back(), errors.front()) << "another start does better than the first";

  const TrainedNetwork once = train(6), again = train(6);
  EXPECT_TRUE(std::ranges::equal(once.network.weights(), again.network.weights()));
  EXPECT_EQ(mean_squared_error(once.network, validation), errors.back())
      << "the weights that go with it";
}

TEST(TrainNetwork, AveragesTheBestOfItsRestarts) {
  const auto training = stand_in_samples(3, 300), validation = stand_in_samples(4, 300);
  TrainingSettings settings = short_training(6);
  settings.averaged = 3;
  const TrainedNetwork trained = train_network(training, validation, settings);
  EXPECT_EQ(trained.network.hidden(), 6U);
  ASSERT_EQ(trained.results.size(), 3U);
  EXPECT_TRUE(std::ranges::is_sorted(trained.results, {}, error_of));
  settings.averaged = 1;
  EXPECT_EQ(error_of(trained.results[0]),
            error_of(train_network(training, validation, settings).results[0]));
  double members = 0;
  for (const TrainingResult& result : trained.results) members += error_of(result) / 3;
  EXPECT_LT(mean_squared_error(trained.network, validation), members);

  settings.averaged = 100;
  settings.restarts = 2;
  EXPECT_EQ(train_network(training, validation, settings).results.size(), 2U) << "all there are";
}

TEST(MeanOf, OutputsTheMeanOfTheSums) {
  const auto samples = stand_in_samples(5, 50);
  std::vector<Network> networks;
  for (const std::size_t hidden : {3U, 1U, 5U}) {
    networks.emplace_back(hidden, kFeatures);
    fit_normalisation(networks.back(), samples);
    initialise_weights(networks.back(), Random(7, hidden));
  }
  const Network mean = mean_of(networks);
  EXPECT_EQ(mean.hidden(), 9U);
  EXPECT_EQ(mean.inputs(), kFeatures);
  for (const Sample& sample : samples) {
    const Network::Outputs of_mean = sums(mean, sample.features);
    for (std::size_t k = 0; k < Network::kOutputs; ++k) {
      double expected = 0;
      for (const Network& network : networks) expected += sums(network, sample.features)[k] / 3;
      EXPECT_NEAR(of_mean[k], expected, 1e-9);
    }
  }
  const Network same = mean_of(std::span(networks).first(1));
  EXPECT_TRUE(std::ranges::equal(same.weights(), networks[0].weights()));
}

}  // namespace
}  // namespace scree
