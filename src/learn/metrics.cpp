#include "scree/learn/metrics.hpp"

namespace scree {
namespace {

double share(std::size_t part, std::size_t rest) {
  return part + rest == 0 ? 1 : static_cast<double>(part) / static_cast<double>(part + rest);
}

}  // namespace

double Score::precision() const {
  return share(true_positives, false_positives);
}
double Score::recall() const {
  return share(true_positives, false_negatives);
}
double Score::f1() const {
  return share(2 * true_positives, false_positives + false_negatives);
}

Score& Score::operator+=(const Score& other) {
  true_positives += other.true_positives;
  false_positives += other.false_positives;
  false_negatives += other.false_negatives;
  return *this;
}

Score Scores::all() const {
  Score sum = positive;
  return sum += negative;
}

void Scores::count(Label truth, Label found) {
  const auto score_of = [this](Label label) -> Score& {
    return label == Label::positive ? positive : negative;
  };
  if (truth == found) {
    if (truth != Label::none) ++score_of(truth).true_positives;
    return;
  }
  if (found != Label::none) ++score_of(found).false_positives;
  if (truth != Label::none) ++score_of(truth).false_negatives;
}

Label decide(const Prediction& prediction, double min_confidence) {
  if (static_cast<double>(prediction.confidence()) < min_confidence) return Label::none;
  return prediction.kind() == ObstacleKind::positive ? Label::positive : Label::negative;
}

Scores evaluate(const Network& network, std::span<const Sample> samples, double min_confidence) {
  Scores scores;
  for (const Sample& sample : samples) {
    scores.count(sample.label, decide(network(sample.features), min_confidence));
  }
  return scores;
}

}  // namespace scree
