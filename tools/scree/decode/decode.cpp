#include "decode/decode.hpp"

#include <map>
#include <memory>

#include "commands.hpp"
#include "common/words.hpp"

namespace scree::cli {
namespace {

const std::map<std::string, void (*)(const DecodeOptions&)>& sensors() {
  static const std::map<std::string, void (*)(const DecodeOptions&)> all = {
      {"encoder", decode_encoder},
      {"imu", decode_imu},
      {"lidar", decode_lidar},
  };
  return all;
}

}  // namespace

void add_decode(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("decode", "What the decoders read, as CSV");
  const auto options = std::make_shared<DecodeOptions>();
  command->add_option("capture", options->capture, "Folder, .pcap, .pcapng or LCM log")->required();
  command->add_option("--sensor", options->sensor, "Which sensor's values")
      ->required()
      ->check(one_of(names_of(sensors())));
  command->add_option("--out", options->out, "CSV file; standard output when not given");
  command->add_option(
      "--pcd", options->pcd,
      "Lidar: folder for one PCD a sweep as well; of two equal dual returns it has one");
  command->add_option("--config", options->config,
                      "Configuration; the capture's own scree.toml when not given");
  options->outputs.add_to(*command);
  command->callback([options] {
    if (!options->pcd.empty() && options->sensor != "lidar") {
      throw CLI::ValidationError("--pcd", "is for the lidar");
    }
    if (options->out == "-") options->out.clear();
    options->outputs.require_free({options->out}, {options->capture, options->config});
    options->outputs.require_empty(options->pcd);
    sensors().at(options->sensor)(*options);
  });
}

}  // namespace scree::cli
