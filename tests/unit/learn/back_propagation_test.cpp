#include "scree/learn/back_propagation.hpp"

#include <gtest/gtest.h>

#include "scree/learn/metrics.hpp"
#include "unit/learn/stand_in_samples.hpp"

namespace scree {
namespace {

Network fresh_network(std::span<const Sample> samples) {
  Network network(5);
  fit_normalisation(network, samples);
  initialise_weights(network, Random(1));
  return network;
}

TEST(BackPropagation, GradientAgreesWithDifferences) {
  const auto samples = stand_in_samples(3, 700);  // more than one block
  Network network = fresh_network(samples);
  const Eigen::VectorXd analytic = gradient(network, samples);
  constexpr double kStep = 1e-6;
  for (Eigen::Index i = 0; i < analytic.size(); ++i) {
    double& weight = network.weights()[static_cast<std::size_t>(i)];
    const double kept = weight;
    weight = kept + kStep;
    const double above = mean_squared_error(network, samples);
    weight = kept - kStep;
    const double below = mean_squared_error(network, samples);
    weight = kept;
    EXPECT_NEAR((above - below) / (2 * kStep), analytic[i], 1e-9) << "weight " << i;
  }
}

TEST(BackPropagation, AStepIsRateTimesGradientAndMomentumRepeatsIt) {
  const auto samples = stand_in_samples(5, 40);
  const Network start = fresh_network(samples);
  const auto trained = [&](int iterations, double momentum) {
    Network network = start;
    // Judged by itself, the error falls in each of the few steps: the last weights are the best.
    train_back_propagation(network, samples, {},
                           {.rate = 0.1, .momentum = momentum, .iterations = iterations});
    return network;
  };
  const Network one = trained(1, 0.5);
  const Network two = trained(2, 0.5);
  const Eigen::VectorXd first = gradient(start, samples);
  const Eigen::VectorXd second = gradient(one, samples);
  for (std::size_t i = 0; i < start.weights().size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double step = -0.1 * first[at];
    EXPECT_NEAR(one.weights()[i], start.weights()[i] + step, 1e-12);
    EXPECT_NEAR(two.weights()[i], one.weights()[i] + 0.5 * step - 0.1 * second[at], 1e-12);
  }
}

TEST(BackPropagation, LearnsButSlowerThanLevenbergMarquardt) {
  const auto samples = stand_in_samples(1, 300);
  const auto validation = stand_in_samples(2, 300);
  Network slow = fresh_network(samples);
  Network fast = slow;
  const auto plain = train_back_propagation(slow, samples, validation, {.iterations = 400});
  const auto damped = train_levenberg_marquardt(fast, samples, validation);
  EXPECT_EQ(plain.curve.size(), 401U);
  EXPECT_GT(evaluate(slow, validation, 0.5).all().f1(), 0.9);
  EXPECT_LT(damped.curve[20].training_error, plain.curve[400].training_error);
}

TEST(BackPropagation, KeepsTheBestAndSurvivesAWildRate) {
  const auto samples = stand_in_samples(1, 100);
  Network network = fresh_network(samples);
  const auto result = train_back_propagation(network, samples, {}, {.rate = 1e9, .iterations = 20});
  const double best = result.curve[result.best].training_error;
  EXPECT_DOUBLE_EQ(mean_squared_error(network, samples), best);
  for (const TrainingStep& step : result.curve) EXPECT_GE(step.training_error, best);
}

TEST(BackPropagation, NoSamplesChangeNothing) {
  Network network(3);
  initialise_weights(network, Random(1));
  const Network before = network;
  train_back_propagation(network, {}, {}, {.iterations = 5});
  EXPECT_TRUE(std::ranges::equal(network.weights(), before.weights()));
}

}  // namespace
}  // namespace scree
