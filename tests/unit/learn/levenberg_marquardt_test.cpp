#include "scree/learn/levenberg_marquardt.hpp"

#include <gtest/gtest.h>

#include "scree/learn/metrics.hpp"
#include "unit/learn/stand_in_samples.hpp"

namespace scree {
namespace {

Network fresh_network(std::size_t hidden, std::span<const Sample> samples, std::uint64_t seed) {
  Network network(hidden);
  fit_normalisation(network, samples);
  initialise_weights(network, Random(seed));
  return network;
}

/// Exclusive or of the signs of two heights: no single layer can tell it.
std::vector<Sample> exclusive_or() {
  std::vector<Sample> samples;
  for (const float a : {-1.0F, 1.0F}) {
    for (const float b : {-1.0F, 1.0F}) {
      samples.push_back({{a, b, 0, 0, 0}, a * b < 0 ? Label::positive : Label::negative});
    }
  }
  return samples;
}

TEST(LevenbergMarquardt, JacobianAgreesWithDifferences) {
  const auto samples = stand_in_samples(3, 7);
  Network network = fresh_network(6, samples, 1);
  const Eigen::MatrixXd analytic = jacobian(network, samples);
  ASSERT_EQ(analytic.rows(), 14);
  ASSERT_EQ(analytic.cols(), 6 * 6 + 2 * 7);
  constexpr double kStep = 1e-6;
  for (Eigen::Index i = 0; i < analytic.cols(); ++i) {
    double& weight = network.weights()[static_cast<std::size_t>(i)];
    const double kept = weight;
    weight = kept + kStep;
    const Eigen::VectorXd above = errors(network, samples);
    weight = kept - kStep;
    const Eigen::VectorXd below = errors(network, samples);
    weight = kept;
    const Eigen::VectorXd numeric = (above - below) / (2 * kStep);
    EXPECT_LT((numeric - analytic.col(i)).cwiseAbs().maxCoeff(), 1e-8) << "weight " << i;
  }
}

TEST(LevenbergMarquardt, OneStepIsTheFormula) {
  const auto samples = stand_in_samples(5, 40);
  Network network = fresh_network(3, samples, 2);
  const Eigen::MatrixXd j = jacobian(network, samples);
  const Eigen::VectorXd e = errors(network, samples);
  const auto weights = network.weights();
  const Eigen::VectorXd before =
      Eigen::Map<Eigen::VectorXd>(weights.data(), static_cast<Eigen::Index>(weights.size()));
  LevenbergMarquardtSettings settings;
  settings.max_iterations = 1;
  const auto result = train_levenberg_marquardt(network, samples, {}, settings);
  ASSERT_EQ(result.curve.size(), 2U);
  const double used = result.curve[1].damping * settings.damping_factor;
  const Eigen::MatrixXd h =
      j.transpose() * j + used * Eigen::MatrixXd::Identity(j.cols(), j.cols());
  const Eigen::VectorXd expected = before - h.inverse() * j.transpose() * e;
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(network.weights()[static_cast<std::size_t>(i)], expected[i], 1e-8);
  }
}

TEST(LevenbergMarquardt, LearnsExclusiveOr) {
  const auto samples = exclusive_or();
  int solved = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Network network = fresh_network(4, samples, seed);
    train_levenberg_marquardt(network, samples, {});
    solved += mean_squared_error(network, samples) < 1e-3 ? 1 : 0;
  }
  EXPECT_GE(solved, 8);
}

TEST(LevenbergMarquardt, ErrorFallsAndStandInClustersAreTold) {
  const auto training = stand_in_samples(1, 1500);
  const auto validation = stand_in_samples(2, 500);
  const auto held_out = stand_in_samples(3, 500);
  Network network = fresh_network(8, training, 1);
  const auto result = train_levenberg_marquardt(network, training, validation);
  for (std::size_t i = 1; i < result.curve.size(); ++i) {
    EXPECT_LT(result.curve[i].training_error, result.curve[i - 1].training_error);
  }
  EXPECT_DOUBLE_EQ(mean_squared_error(network, validation),
                   result.curve[result.best].validation_error);
  EXPECT_GT(evaluate(network, held_out, 0.5).all().f1(), 0.95);
}

TEST(LevenbergMarquardt, SameSeedSameWeights) {
  const auto samples = stand_in_samples(1, 300);
  Network a = fresh_network(5, samples, 7);
  Network b = fresh_network(5, samples, 7);
  train_levenberg_marquardt(a, samples, {});
  train_levenberg_marquardt(b, samples, {});
  EXPECT_EQ(a.to_text(""), b.to_text(""));
  EXPECT_NE(a.to_text(""), fresh_network(5, samples, 8).to_text(""));
}

TEST(LevenbergMarquardt, NothingToLearnFromEndsAtOnce) {
  Network network = fresh_network(3, {}, 1);
  const auto result = train_levenberg_marquardt(network, {}, {});
  EXPECT_EQ(result.stop, StopReason::damping);
  const std::vector<Sample> same(10, Sample{{1, 1, 1, 1, 1}, Label::positive});
  network = fresh_network(3, same, 1);
  train_levenberg_marquardt(network, same, {});
  EXPECT_GT(network(same[0].features).positive, 0.99F);
}

TEST(Metrics, WrongKindCountsTwice) {
  Scores scores;
  scores.count(Label::positive, Label::positive);
  scores.count(Label::positive, Label::negative);
  scores.count(Label::negative, Label::none);
  scores.count(Label::none, Label::positive);
  scores.count(Label::none, Label::none);
  EXPECT_EQ(scores.positive.true_positives, 1U);
  EXPECT_EQ(scores.positive.false_positives, 1U);
  EXPECT_EQ(scores.positive.false_negatives, 1U);
  EXPECT_EQ(scores.negative.false_positives, 1U);
  EXPECT_EQ(scores.negative.false_negatives, 1U);
  EXPECT_DOUBLE_EQ(scores.all().precision(), 1.0 / 3);
  EXPECT_DOUBLE_EQ(scores.all().recall(), 1.0 / 3);
  EXPECT_DOUBLE_EQ(scores.all().f1(), 1.0 / 3);
  EXPECT_DOUBLE_EQ(Score{}.f1(), 1);
}

TEST(Random, IsTheSameEverywhereAndNormalIsNormal) {
  EXPECT_EQ(Random(1234567).next(), 6457827717110365317U);  // published SplitMix64 vector
  Random random(1);
  double sum = 0;
  double squares = 0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.normal();
    sum += value;
    squares += value * value;
  }
  EXPECT_NEAR(sum / kCount, 0, 0.01);
  EXPECT_NEAR(squares / kCount, 1, 0.02);
}

}  // namespace
}  // namespace scree
