#pragma once

#include <memory>
#include <span>
#include <vector>

#include "scree/learn/sample.hpp"

struct svm_model;
struct svm_node;

namespace scree::cli {

/// A support vector machine with a radial kernel (libsvm), the other classifier that the paper is
/// held against (fig. 21). Answers none, positive or negative.
class Svm {
public:
  struct Settings {
    double cost = 1;   ///< C: what a sample on the wrong side costs
    double width = 1;  ///< gamma of exp(-gamma |a - b|^2)
  };

  /// @param normalisation whose forms, means and scales the features go through, and how many
  Svm(std::span<const Sample> samples, const Network& normalisation, const Settings& settings);
  ~Svm();
  Svm(Svm&&) noexcept;
  Svm& operator=(Svm&&) noexcept;

  Label operator()(const Features& features) const;

private:
  std::vector<svm_node> nodes_of(const Features& features) const;

  Network normalisation_;
  std::vector<std::vector<svm_node>> rows_;  // the model points into them
  struct Free {
    void operator()(svm_model* model) const;
  };
  std::unique_ptr<svm_model, Free> model_;
};

}  // namespace scree::cli
