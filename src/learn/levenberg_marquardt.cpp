#include "scree/learn/levenberg_marquardt.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

namespace scree {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kOutputs = static_cast<Index>(Network::kOutputs);

/// Fills the rows of one sample: errors, and their derivatives unless `rows` is null.
void fill(const Network& network, const Sample& sample, Eigen::Ref<VectorXd> error,
          Eigen::Ref<MatrixXd>* rows) {
  std::array<double, Network::kMaxHidden> hidden;
  const Network::Inputs inputs = network.normalised(sample.features);
  const Network::Outputs outputs = network.forward(inputs, hidden);
  const Network::Outputs target = target_of(sample.label);
  for (std::size_t k = 0; k < Network::kOutputs; ++k) {
    const auto row = static_cast<Index>(k);
    error[row] = target[k] - outputs[k];
    if (rows == nullptr) continue;
    const double slope = -outputs[k] * (1 - outputs[k]);
    const std::size_t output_row = network.output_row(k);
    for (std::size_t unit = 0; unit < network.hidden(); ++unit) {
      const double value = hidden[unit];
      (*rows)(row, static_cast<Index>(output_row + unit)) = slope * value;
      const double through = slope * network.weights()[output_row + unit] * value * (1 - value);
      const auto column = static_cast<Index>(unit * (network.inputs() + 1));
      for (std::size_t i = 0; i < network.inputs(); ++i) {
        (*rows)(row, column + static_cast<Index>(i)) = through * inputs[i];
      }
      (*rows)(row, column + static_cast<Index>(network.inputs())) = through;
    }
    (*rows)(row, static_cast<Index>(output_row + network.hidden())) = slope;
  }
}

/// J^T J and J^T e, summed over blocks of samples so that J never stands in memory as a whole.
struct NormalEquations {
  MatrixXd jtj;
  VectorXd jte;
};

NormalEquations normal_equations(const Network& network, std::span<const Sample> samples) {
  constexpr std::size_t kBlock = 512;
  const auto weights = static_cast<Index>(network.weights().size());
  NormalEquations sums{MatrixXd::Zero(weights, weights), VectorXd::Zero(weights)};
  for (std::size_t begin = 0; begin < samples.size(); begin += kBlock) {
    const auto block = samples.subspan(begin, std::min(kBlock, samples.size() - begin));
    const MatrixXd j = jacobian(network, block);
    sums.jtj.selfadjointView<Eigen::Lower>().rankUpdate(j.transpose());
    sums.jte.noalias() += j.transpose() * errors(network, block);
  }
  return sums;
}

void set_weights(Network& network, const VectorXd& weights) {
  std::copy(weights.begin(), weights.end(), network.weights().begin());
}

VectorXd weights_of(const Network& network) {
  const auto weights = network.weights();
  return Eigen::Map<const VectorXd>(weights.data(), static_cast<Index>(weights.size()));
}

/// Tries steps with growing damping until one lowers the error; false when none does.
bool step(Network& network, std::span<const Sample> training, double error, double& damping,
          const LevenbergMarquardtSettings& settings) {
  const NormalEquations equations = normal_equations(network, training);
  const VectorXd weights = weights_of(network);
  for (; damping <= settings.max_damping; damping *= settings.damping_factor) {
    MatrixXd damped = equations.jtj;
    damped.diagonal().array() += damping;
    const Eigen::LLT<MatrixXd> factor(damped);
    if (factor.info() != Eigen::Success) continue;
    const VectorXd moved = weights - factor.solve(equations.jte);
    const bool in_bounds = moved.allFinite() && moved.cwiseAbs().maxCoeff() < Network::kMaxWeight;
    if (in_bounds) {
      set_weights(network, moved);
      if (mean_squared_error(network, training) < error) {
        damping = std::max(damping / settings.damping_factor, 1e-15);
        return true;
      }
    }
  }
  set_weights(network, weights);
  return false;
}

}  // namespace

std::string_view name_of(StopReason reason) {
  switch (reason) {
    case StopReason::iterations:
      return "most iterations reached";
    case StopReason::converged:
      return "training error no longer falls";
    case StopReason::validation:
      return "validation error no longer falls";
    case StopReason::damping:
      return "no step lowers the error";
  }
  return "?";
}

VectorXd errors(const Network& network, std::span<const Sample> samples) {
  VectorXd all(static_cast<Index>(samples.size()) * kOutputs);
  Index row = 0;
  for (const Sample& sample : samples) {
    fill(network, sample, all.segment(row, kOutputs), nullptr);
    row += kOutputs;
  }
  return all;
}

MatrixXd jacobian(const Network& network, std::span<const Sample> samples) {
  const auto rows = static_cast<Index>(samples.size()) * kOutputs;
  MatrixXd all = MatrixXd::Zero(rows, static_cast<Index>(network.weights().size()));
  VectorXd unused(kOutputs);
  Index row = 0;
  for (const Sample& sample : samples) {
    Eigen::Ref<MatrixXd> part = all.middleRows(row, kOutputs);
    fill(network, sample, unused, &part);
    row += kOutputs;
  }
  return all;
}

double mean_squared_error(const Network& network, std::span<const Sample> samples) {
  if (samples.empty()) return 0;
  const VectorXd all = errors(network, samples);
  return all.squaredNorm() / static_cast<double>(all.size());
}

TrainingResult train_levenberg_marquardt(Network& network, std::span<const Sample> training,
                                         std::span<const Sample> validation,
                                         const LevenbergMarquardtSettings& settings) {
  const auto held_out = validation.empty() ? training : validation;
  double damping = settings.damping;
  TrainingResult result;
  result.curve.push_back(
      {mean_squared_error(network, training), mean_squared_error(network, held_out), damping});
  VectorXd best = weights_of(network);
  int idle = 0;
  int worse = 0;
  for (int i = 0; i < settings.max_iterations; ++i) {
    const double error = result.curve.back().training_error;
    if (!step(network, training, error, damping, settings)) {
      result.stop = StopReason::damping;
      break;
    }
    result.curve.push_back(
        {mean_squared_error(network, training), mean_squared_error(network, held_out), damping});
    const TrainingStep& now = result.curve.back();
    idle = now.training_error < error * (1 - settings.least_gain) ? 0 : idle + 1;
    if (now.validation_error < result.curve[result.best].validation_error) {
      result.best = result.curve.size() - 1;
      best = weights_of(network);
      worse = 0;
    } else {
      ++worse;
    }
    if (idle >= settings.patience || worse >= settings.patience) {
      result.stop = idle >= settings.patience ? StopReason::converged : StopReason::validation;
      break;
    }
  }
  set_weights(network, best);
  return result;
}

}  // namespace scree
