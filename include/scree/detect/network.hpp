#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scree/core/obstacle.hpp"
#include "scree/core/result.hpp"
#include "scree/detect/features.hpp"

namespace scree {

/// What the network says of one cluster: how surely it is an obstacle of each kind, 0..1 each.
/// Both low: no obstacle.
struct Prediction {
  float positive = 0;
  float negative = 0;

  ObstacleKind kind() const {
    return negative > positive ? ObstacleKind::negative : ObstacleKind::positive;
  }
  float confidence() const { return negative > positive ? negative : positive; }
};

/// How a feature enters the network before it is centred and scaled.
enum class InputForm : std::uint8_t {
  raw,    ///< as it is
  log1p,  ///< log(1 + x); for counts, which span decades from a sparse sweep to a dense cloud
  root,   ///< its square root, with its sign; for lengths, whose small values tell most
  logit   ///< log((x + 0.01) / (1.01 - x)), x cut to 0..1; for confidences, whose ends matter most
};

/// The paper's network (section 3.1, fig. 9): features in, the paper's five or more, one hidden
/// layer of sigmoids, two sigmoids out. Each input is (form(feature) - mean) / scale, cut to +-100.
/// All in double, so that a file saved and loaded gives the same outputs bit for bit.
class Network {
public:
  static constexpr std::size_t kOutputs = 2;  ///< positive, negative
  static constexpr std::size_t kMaxHidden = 64;
  /// Weights beyond this are refused: below it no sum can overflow.
  static constexpr double kMaxWeight = 1e6;

  using Inputs = std::array<double, kFeatures>;  ///< the first inputs() of them count
  using Outputs = std::array<double, kOutputs>;
  using Forms = std::array<InputForm, kFeatures>;

  /// Counts enter as logarithms, the rest raw. Measured on held-out clouds the two forms of the
  /// counts cannot be told apart: F1 0.983 as logarithms and 0.985 raw at the density trained on,
  /// 0.90 both at a third of it. The logarithm is taken because it grows least beyond what was
  /// trained.
  static constexpr Forms kDefaultForms = {InputForm::raw, InputForm::raw, InputForm::raw,
                                          InputForm::log1p, InputForm::log1p};

  /// All weights zero. Takes the first `inputs` of the features.
  /// @pre 1 <= hidden <= kMaxHidden, 1 <= inputs <= kFeatures
  explicit Network(std::size_t hidden = 1, std::size_t inputs = kPaperFeatures);

  /// Reads a text file as save() writes it. The error names the file, the line and what is wrong
  /// with it: another format, a wrong shape, missing or extra numbers, a number that is not finite
  /// or too large, a scale that is not above zero.
  static Result<Network> load(const std::filesystem::path& file);
  /// The same from text; `origin` stands for the file's name in errors.
  static Result<Network> parse(std::string_view text, const std::string& origin);
  /// `provenance` becomes comment lines at the head of the file. Fails when it cannot be written.
  Result<void> save(const std::filesystem::path& file, std::string_view provenance) const;
  std::string to_text(std::string_view provenance) const;

  /// Allocates nothing. Infinite and huge features are cut as said above; NaN gives {0, 0}.
  Prediction operator()(const Features& features) const noexcept;

  std::size_t hidden() const noexcept { return hidden_; }
  std::size_t inputs() const noexcept { return inputs_; }
  /// Features as the first layer sees them.
  Inputs normalised(const Features& features) const noexcept;
  /// Both layers; `hidden_values` has room for hidden() outputs of the hidden layer.
  Outputs forward(const Inputs& inputs, std::span<double> hidden_values) const noexcept;

  /// Row by row: for each hidden unit its inputs() weights and its bias, then for each output its
  /// hidden() weights and its bias.
  std::span<const double> weights() const noexcept { return weights_; }
  std::span<double> weights() noexcept { return weights_; }
  /// Where in weights() the row of an output begins.
  std::size_t output_row(std::size_t output) const noexcept {
    return hidden_ * (inputs_ + 1) + output * (hidden_ + 1);
  }

  Forms forms = kDefaultForms;
  Inputs mean{};   ///< of each input after its form
  Inputs scale{};  ///< its standard deviation, above zero

private:
  std::size_t hidden_, inputs_;
  std::vector<double> weights_;
};

/// A feature in its form, before centring.
double apply(InputForm form, float feature) noexcept;

}  // namespace scree
