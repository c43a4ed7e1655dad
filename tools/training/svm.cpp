#include "training/svm.hpp"

#include <libsvm/svm.h>

namespace scree::cli {

void Svm::Free::operator()(svm_model* model) const {
  svm_free_and_destroy_model(&model);
}

Svm::Svm(std::span<const Sample> samples, const Network& normalisation, const Settings& settings)
    : normalisation_(normalisation) {
  svm_set_print_string_function([](const char*) {});
  std::vector<svm_node*> starts;
  std::vector<double> labels;
  rows_.reserve(samples.size());
  for (const Sample& sample : samples) {
    rows_.push_back(nodes_of(sample.features));
    starts.push_back(rows_.back().data());
    labels.push_back(static_cast<double>(sample.label));
  }
  svm_problem problem{static_cast<int>(samples.size()), labels.data(), starts.data()};
  svm_parameter parameter{};
  parameter.svm_type = C_SVC;
  parameter.kernel_type = RBF;
  parameter.C = settings.cost;
  parameter.gamma = settings.width;
  parameter.cache_size = 100;  // megabytes
  parameter.eps = 1e-3;
  parameter.shrinking = 1;
  model_.reset(svm_train(&problem, &parameter));
}

Svm::~Svm() = default;
Svm::Svm(Svm&&) noexcept = default;
Svm& Svm::operator=(Svm&&) noexcept = default;

std::vector<svm_node> Svm::nodes_of(const Features& features) const {
  const Network::Inputs inputs = normalisation_.normalised(features);
  std::vector<svm_node> nodes;
  for (std::size_t i = 0; i < normalisation_.inputs(); ++i) {
    nodes.push_back({static_cast<int>(i) + 1, inputs[i]});
  }
  nodes.push_back({-1, 0});  // the end
  return nodes;
}

Label Svm::operator()(const Features& features) const {
  const auto nodes = nodes_of(features);
  return static_cast<Label>(static_cast<int>(svm_predict(model_.get(), nodes.data())));
}

}  // namespace scree::cli
