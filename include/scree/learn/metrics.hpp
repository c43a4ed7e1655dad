#pragma once

#include <cstddef>
#include <span>

#include "scree/detect/network.hpp"
#include "scree/learn/sample.hpp"

namespace scree {

/// True and false positives, false negatives; the paper's three measures (section 3.2). A measure
/// of nothing is 1: no mistake was made.
struct Score {
  std::size_t true_positives = 0;
  std::size_t false_positives = 0;
  std::size_t false_negatives = 0;

  double precision() const;
  double recall() const;
  double f1() const;
  Score& operator+=(const Score& other);
};

/// Detection and kind together: an obstacle taken for the other kind is a false positive of that
/// kind and a false negative of its own.
struct Scores {
  Score positive, negative;

  Score all() const;
  /// Counts one cluster. `found` is Label::none where nothing was reported.
  void count(Label truth, Label found);
};

/// What the detector reports for this prediction.
Label decide(const Prediction& prediction, double min_confidence);
Scores evaluate(const Network& network, std::span<const Sample> samples, double min_confidence);

}  // namespace scree
