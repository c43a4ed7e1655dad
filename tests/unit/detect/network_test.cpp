#include "scree/detect/network.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kGood =
    "# trained by hand\n"
    "scree_network 1\n"
    "inputs 5\n"
    "hidden 2\n"
    "outputs 2\n"
    "form raw raw raw log1p log1p\n"
    "mean 0.1 0.2 0.3 4 5\n"
    "scale 1 2 0.5 1.5 2.5\n"
    "unit 0.5 -1 2 0.25 -0.125 0.1\n"
    "unit -0.5 1 1.5 -0.75 0.6 -0.2\n"
    "output 1.5 -2 0.3\n"
    "output -1 2.5 -0.4\n";

/// The error that a file gives in which `from` stands as `to`.
std::string error_with(const std::string& from, const std::string& to) {
  std::string text = kGood;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  const auto network = Network::parse(text, "net.txt");
  return network ? "no error" : network.error().message;
}

Network random_network(std::size_t hidden) {
  Network network(hidden, kFeatures);
  double value = 0.37;
  for (double& weight : network.weights()) {
    value = 3.9 * value * (1 - value);
    weight = 4 * value - 2;
  }
  for (std::size_t i = 0; i < kFeatures; ++i) {
    network.mean[i] = 1.0 / 3 - 0.3 * static_cast<double>(i);
    network.scale[i] = 0.1 + 2.0 / 3 * static_cast<double>(i);
  }
  return network;
}

TEST(Network, ForwardPassAgreesWithTheFormulasWrittenOut) {
  const auto network = Network::parse(kGood, "net.txt");
  ASSERT_TRUE(network) << network.error().message;
  const auto sigmoid = [](double x) { return 1.0 / (1.0 + std::exp(-x)); };
  const double a = (0.4 - 0.1) / 1, b = (0.9 - 0.2) / 2, c = (-0.1 - 0.3) / 0.5,
               d = (std::log(31.0) - 4) / 1.5, e = (std::log(8.0) - 5) / 2.5;
  const double h1 = sigmoid(0.5 * a - b + 2 * c + 0.25 * d - 0.125 * e + 0.1);
  const double h2 = sigmoid(-0.5 * a + b + 1.5 * c - 0.75 * d + 0.6 * e - 0.2);
  const Prediction prediction = (*network)({0.4F, 0.9F, -0.1F, 30, 7});
  EXPECT_NEAR(prediction.positive, sigmoid(1.5 * h1 - 2 * h2 + 0.3), 1e-6);
  EXPECT_NEAR(prediction.negative, sigmoid(-h1 + 2.5 * h2 - 0.4), 1e-6);
}

TEST(Network, SaveAndLoadGiveTheSameNetworkExactly) {
  const Network network = random_network(17);
  const TemporaryFolder folder;
  const auto file = folder / "network.txt";
  ASSERT_TRUE(network.save(file, "seeds 1-3\n\nhidden 17"));
  const auto loaded = Network::load(file);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_TRUE(std::ranges::equal(loaded->weights(), network.weights()));
  EXPECT_EQ(loaded->mean, network.mean);
  EXPECT_EQ(loaded->scale, network.scale);
  EXPECT_EQ(loaded->forms, network.forms);
  EXPECT_THAT(network.to_text("seeds 1-3\n\nhidden 17"),
              HasSubstr("# seeds 1-3\n#\n# hidden 17\n"));
}

TEST(Network, RefusalsNameFileLineAndReason) {
  EXPECT_EQ(error_with("# trained", "# trained"), "no error");
  EXPECT_THAT(error_with("scree_network 1", "pickle 1"),
              AllOf(HasSubstr("net.txt:2"), HasSubstr("'pickle' where 'scree_network' belongs")));
  EXPECT_THAT(error_with("scree_network 1", "scree_network 2"), HasSubstr("version 2 is not 1"));
  EXPECT_THAT(error_with("inputs 5", "inputs 99"), HasSubstr("99 inputs, there are"));
  EXPECT_THAT(error_with("inputs 5", "inputs 0"), HasSubstr("0 inputs"));
  EXPECT_THAT(error_with("inputs 5", "inputs 4"), HasSubstr("has 5 values and needs 4"));
  EXPECT_THAT(error_with("hidden 2", "hidden 65"), AllOf(HasSubstr(":4:"), HasSubstr("1 to 64")));
  EXPECT_THAT(error_with("hidden 2", "hidden 0"), HasSubstr("0 hidden units"));
  EXPECT_THAT(error_with("hidden 2", "hidden 99999999999"), HasSubstr("not a whole number"));
  EXPECT_THAT(error_with("hidden 2", "hidden 3"), HasSubstr("'output' where 'unit' belongs"));
  EXPECT_THAT(error_with("hidden 2", "hidden 1"), HasSubstr("'unit' where 'output' belongs"));
  EXPECT_THAT(error_with("outputs 2", "outputs 3"), HasSubstr("3 outputs"));
  EXPECT_THAT(error_with("raw log1p", "raw sqrt"), HasSubstr("'sqrt' is no form"));
  EXPECT_THAT(error_with("4 5\n", "4\n"),
              AllOf(HasSubstr(":7:"), HasSubstr("has 4 values and needs 5")));
  EXPECT_THAT(error_with("0.1\nunit", "0.1 7\nunit"), HasSubstr("has 7 values and needs 6"));
  EXPECT_THAT(error_with("-0.75", "nan"), AllOf(HasSubstr(":10:"), HasSubstr("not a finite")));
  EXPECT_THAT(error_with("-0.75", "-inf"), HasSubstr("not a finite"));
  EXPECT_THAT(error_with("-0.75", "1e999"), HasSubstr("not a finite"));
  EXPECT_THAT(error_with("-0.75", "1e7"), HasSubstr("beyond"));
  EXPECT_THAT(error_with("-0.75", "0,75"), HasSubstr("not a number"));
  EXPECT_THAT(error_with("scale 1 2", "scale 1 0"),
              AllOf(HasSubstr(":8:"), HasSubstr("scale is 0")));
  EXPECT_THAT(error_with("scale 1 2", "scale 1 -2"), HasSubstr("scale is -2"));
  EXPECT_THAT(error_with("output -1 2.5 -0.4\n", ""), HasSubstr("ends before its line 'output'"));
  EXPECT_THAT(error_with("-0.4\n", "-0.4\nunit 1\n"), HasSubstr("'unit' follows the last output"));
  EXPECT_FALSE(Network::parse("", "net.txt"));
  EXPECT_THAT(Network::load("/nonexistent/net.txt").error().message,
              HasSubstr("/nonexistent/net.txt"));
  EXPECT_FALSE(Network::load("/"));
}

TEST(Network, FormsAreWhatTheySay) {
  EXPECT_EQ(apply(InputForm::raw, -3), -3);
  EXPECT_DOUBLE_EQ(apply(InputForm::log1p, 3), std::log(4));
  EXPECT_EQ(apply(InputForm::log1p, -3), 0);
  EXPECT_EQ(apply(InputForm::root, 0.25F), 0.5);
  EXPECT_EQ(apply(InputForm::root, -4), -2) << "depths keep their sign";
  EXPECT_DOUBLE_EQ(apply(InputForm::logit, 0.5F), 0);
  EXPECT_NEAR(apply(InputForm::logit, 1), std::log(101), 1e-9);
  EXPECT_NEAR(apply(InputForm::logit, 0.25F), -apply(InputForm::logit, 0.75F), 1e-12);
  EXPECT_EQ(apply(InputForm::logit, -7), apply(InputForm::logit, 0)) << "cut to 0..1";
  EXPECT_EQ(apply(InputForm::logit, 7), apply(InputForm::logit, 1));
}

TEST(Network, AnswersStayBetweenZeroAndOneWhateverTheFeatures) {
  Network network = random_network(Network::kMaxHidden);
  constexpr float kInf = std::numeric_limits<float>::infinity();
  constexpr float kHuge = std::numeric_limits<float>::max();
  for (double gain : {1.0, 1e5}) {
    for (double& weight : network.weights()) weight *= gain;
    for (const Features& features :
         {Features{kHuge, -kHuge, kHuge, kHuge, kHuge}, Features{kInf, -kInf, kInf, kInf, kInf},
          Features{0, 0, 0, -5, -kInf}, Features{}}) {
      const Prediction prediction = network(features);
      EXPECT_TRUE(prediction.positive >= 0 && prediction.positive <= 1) << prediction.positive;
      EXPECT_TRUE(prediction.negative >= 0 && prediction.negative <= 1) << prediction.negative;
    }
  }
  const Prediction prediction = network({0, std::nanf(""), 0, 1, 1});
  EXPECT_EQ(prediction.positive, 0.0F);
  EXPECT_EQ(prediction.negative, 0.0F);
}

TEST(Network, AnswerGivesKindAndConfidence) {
  EXPECT_EQ((Prediction{0.9F, 0.2F}).kind(), ObstacleKind::positive);
  EXPECT_EQ((Prediction{0.1F, 0.2F}).kind(), ObstacleKind::negative);
  EXPECT_EQ((Prediction{0.1F, 0.2F}).confidence(), 0.2F);
}

}  // namespace
}  // namespace scree
