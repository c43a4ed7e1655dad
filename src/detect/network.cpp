#include "scree/detect/network.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

#include "scree/core/read_file.hpp"

namespace scree {
namespace {

constexpr std::string_view kFormat = "scree_network";
constexpr int kVersion = 1;
constexpr double kInputLimit = 5;
constexpr std::array<std::string_view, 4> kFormNames = {"raw", "log1p", "root", "logit"};

double sigmoid(double x) noexcept {
  return 1 / (1 + std::exp(-x));
}

/// Hands out a file's lines as words, leaves out comments, keeps the first mistake.
class LineReader {
public:
  LineReader(std::string_view text, const std::string& origin) : rest_(text), origin_(origin) {}

  /// The next line that says something; empty at the end.
  std::vector<std::string_view> next() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      std::vector<std::string_view> words = split(rest_.substr(0, end));
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++line_;
      if (!words.empty() && !words.front().starts_with('#')) return words;
    }
    return {};
  }

  /// The words after `keyword` on the next line, `count` of them; nothing when it is another line.
  std::optional<std::vector<std::string_view>> expect(std::string_view keyword, std::size_t count) {
    if (error_) return std::nullopt;
    std::vector<std::string_view> words = next();
    if (words.empty()) return refuse(fmt::format("ends before its line '{}'", keyword));
    if (words.front() != keyword) {
      return refuse(fmt::format("has '{}' where '{}' belongs", words.front(), keyword));
    }
    words.erase(words.begin());
    if (words.size() != count) {
      return refuse(fmt::format("'{}' has {} values and needs {}", keyword, words.size(), count));
    }
    return words;
  }

  void numbers(std::string_view keyword, std::span<double> values) {
    const auto words = expect(keyword, values.size());
    if (!words) return;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!number((*words)[i], values[i])) return;
    }
  }

  int whole_number(std::string_view keyword) {
    const auto words = expect(keyword, 1);
    int value = 0;
    if (!words) return value;
    const std::string_view word = words->front();
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (failure != std::errc() || end != word.data() + word.size()) {
      refuse(fmt::format("'{}' is not a whole number", word));
    }
    return value;
  }

  std::nullopt_t refuse(const std::string& reason) {
    if (!error_) error_ = Error{fmt::format("{}:{}: {}", origin_, line_, reason)};
    return std::nullopt;
  }

  const std::optional<Error>& error() const { return error_; }

private:
  static std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> words;
    constexpr std::string_view kBlank = " \t\r";
    for (std::size_t begin = line.find_first_not_of(kBlank); begin != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(kBlank, begin), line.size());
      words.push_back(line.substr(begin, end - begin));
      begin = line.find_first_not_of(kBlank, end);
    }
    return words;
  }

  bool number(std::string_view word, double& value) {
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (failure == std::errc::invalid_argument || end != word.data() + word.size()) {
      refuse(fmt::format("'{}' is not a number", word));
    } else if (!std::isfinite(value) || failure == std::errc::result_out_of_range) {
      refuse(fmt::format("'{}' is not a finite number", word));
    } else if (std::abs(value) > Network::kMaxWeight) {
      refuse(fmt::format("'{}' is beyond {}", word, Network::kMaxWeight));
    }
    return !error_;
  }

  std::string_view rest_;
  const std::string& origin_;
  int line_ = 0;
  std::optional<Error> error_;
};

void read_forms(LineReader& reader, std::span<InputForm> forms) {
  const auto words = reader.expect("form", forms.size());
  if (!words) return;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const auto* const found = std::find(kFormNames.begin(), kFormNames.end(), (*words)[i]);
    if (found == kFormNames.end()) {
      reader.refuse(fmt::format("'{}' is no form of an input, accepted are {}", (*words)[i],
                                fmt::join(kFormNames, ", ")));
      return;
    }
    forms[i] = static_cast<InputForm>(found - kFormNames.begin());
  }
}

}  // namespace

double apply(InputForm form, float feature) noexcept {
  const auto value = static_cast<double>(feature);
  if (form == InputForm::log1p) return std::log1p(std::max(value, 0.0));
  if (form == InputForm::raw) return value;
  if (form == InputForm::root) return std::copysign(std::sqrt(std::abs(value)), value);
  const double share = std::clamp(value, 0.0, 1.0);
  return std::log((share + 0.01) / (1.01 - share));
}

Network::Network(std::size_t hidden, std::size_t inputs)
    : hidden_(hidden), inputs_(inputs), weights_(hidden * (inputs + 1) + kOutputs * (hidden + 1)) {
  assert(hidden >= 1 && hidden <= kMaxHidden && inputs >= 1 && inputs <= kFeatures);
  scale.fill(1);
}

Network::Inputs Network::normalised(const Features& features) const noexcept {
  Inputs inputs{};
  for (std::size_t i = 0; i < inputs_; ++i) {
    const double centred = (apply(forms[i], features[i]) - mean[i]) / scale[i];
    inputs[i] = std::clamp(centred, -kInputLimit, kInputLimit);
  }
  return inputs;
}

Network::Outputs Network::forward(const Inputs& inputs,
                                  std::span<double> hidden_values) const noexcept {
  const double* weight = weights_.data();
  for (std::size_t unit = 0; unit < hidden_; ++unit) {
    double sum = 0;
    for (std::size_t i = 0; i < inputs_; ++i) sum += *weight++ * inputs[i];
    hidden_values[unit] = sigmoid(sum + *weight++);
  }
  Outputs outputs;
  for (double& output : outputs) {
    double sum = 0;
    for (std::size_t unit = 0; unit < hidden_; ++unit) sum += *weight++ * hidden_values[unit];
    output = sigmoid(sum + *weight++);
  }
  return outputs;
}

Prediction Network::operator()(const Features& features) const noexcept {
  for (std::size_t i = 0; i < inputs_; ++i) {
    if (std::isnan(features[i])) return {};
  }
  std::array<double, kMaxHidden> hidden_values;
  const Outputs outputs = forward(normalised(features), hidden_values);
  return {static_cast<float>(outputs[0]), static_cast<float>(outputs[1])};
}

Result<Network> Network::parse(std::string_view text, const std::string& origin) {
  LineReader reader(text, origin);
  const int version = reader.whole_number(kFormat);
  if (version != kVersion)
    reader.refuse(fmt::format("format version {} is not {}", version, kVersion));
  const int inputs = reader.whole_number("inputs");
  if (inputs < 1 || inputs > static_cast<int>(kFeatures)) {
    reader.refuse(
        fmt::format("has {} inputs, there are {} features", inputs, std::size_t{kFeatures}));
  }
  const int hidden = reader.whole_number("hidden");
  if (hidden < 1 || hidden > static_cast<int>(kMaxHidden)) {
    reader.refuse(fmt::format("has {} hidden units, accepted are 1 to {}", hidden, kMaxHidden));
  }
  const int outputs = reader.whole_number("outputs");
  if (outputs != static_cast<int>(kOutputs)) {
    reader.refuse(fmt::format("has {} outputs, accepted are {}", outputs, kOutputs));
  }
  if (reader.error()) return tl::make_unexpected(*reader.error());

  Network network(static_cast<std::size_t>(hidden), static_cast<std::size_t>(inputs));
  const std::size_t used = network.inputs_;
  read_forms(reader, std::span(network.forms).first(used));
  reader.numbers("mean", std::span(network.mean).first(used));
  reader.numbers("scale", std::span(network.scale).first(used));
  for (const double scale : network.scale) {
    if (!(scale >= 1 / kMaxWeight))
      reader.refuse(fmt::format("a scale is {}, below {}", scale, 1 / kMaxWeight));
  }
  std::span<double> rest = network.weights_;
  for (std::size_t unit = 0; unit < network.hidden_; ++unit) {
    reader.numbers("unit", rest.first(used + 1));
    rest = rest.subspan(used + 1);
  }
  for (std::size_t output = 0; output < kOutputs; ++output) {
    reader.numbers("output", rest.first(network.hidden_ + 1));
    rest = rest.subspan(network.hidden_ + 1);
  }
  if (!reader.error()) {
    const auto words = reader.next();
    if (!words.empty()) reader.refuse(fmt::format("'{}' follows the last output", words.front()));
  }
  if (reader.error()) return tl::make_unexpected(*reader.error());
  return network;
}

Result<Network> Network::load(const std::filesystem::path& file) {
  constexpr std::uintmax_t kLargestFile = 1 << 20;
  const auto text = read_file(file, kLargestFile);
  if (!text) return tl::make_unexpected(text.error());
  return parse(*text, file.string());
}

std::string Network::to_text(std::string_view provenance) const {
  std::string text;
  std::istringstream lines{std::string(provenance)};
  for (std::string line; std::getline(lines, line);)
    text += line.empty() ? "#\n" : "# " + line + "\n";
  text += fmt::format("{} {}\ninputs {}\nhidden {}\noutputs {}\nform", kFormat, kVersion, inputs_,
                      hidden_, kOutputs);
  for (const InputForm form : std::span(forms).first(inputs_))
    text += fmt::format(" {}", kFormNames[static_cast<std::size_t>(form)]);
  text += fmt::format("\nmean {}\nscale {}\n", fmt::join(std::span(mean).first(inputs_), " "),
                      fmt::join(std::span(scale).first(inputs_), " "));
  const double* row = weights_.data();
  for (std::size_t unit = 0; unit < hidden_; ++unit, row += inputs_ + 1) {
    text += fmt::format("unit {}\n", fmt::join(row, row + inputs_ + 1, " "));
  }
  for (std::size_t output = 0; output < kOutputs; ++output, row += hidden_ + 1) {
    text += fmt::format("output {}\n", fmt::join(row, row + hidden_ + 1, " "));
  }
  return text;
}

Result<void> Network::save(const std::filesystem::path& file, std::string_view provenance) const {
  std::ofstream stream(file, std::ios::binary);
  stream << to_text(provenance) << std::flush;
  if (!stream) return fail(fmt::format("cannot write the network file {}", file.string()));
  return {};
}

}  // namespace scree
