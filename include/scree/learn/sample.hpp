#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scree/core/random.hpp"
#include "scree/detect/features.hpp"
#include "scree/detect/network.hpp"

namespace scree {

/// What a cluster truly is.
enum class Label : std::uint8_t { none, positive, negative };

/// One cluster for training.
struct Sample {
  Features features{};
  Label label = Label::none;
};

/// What the network should answer.
constexpr Network::Outputs target_of(Label label) {
  return {label == Label::positive ? 1.0 : 0.0, label == Label::negative ? 1.0 : 0.0};
}

/// Sets mean and scale of every input from these samples alone. A feature that never changes keeps
/// scale 1.
void fit_normalisation(Network& network, std::span<const Sample> samples);

/// Small random weights around zero, in proportion to 1/sqrt(inputs of the unit).
void initialise_weights(Network& network, Random random);

}  // namespace scree
