#include "common/lcm_options.hpp"

#include "commands.hpp"
#include "scree/config/settings.hpp"

namespace scree::cli {

void LcmOptions::add_to(CLI::App& command) {
  command.add_option("--config", config, "configuration that names the LCM url")->type_name("FILE");
  command.add_option("--url", url, "LCM url [" + Settings().lcm.url + "]")->type_name("URL");
}

std::string LcmOptions::url_of() const {
  if (!url.empty()) return url;
  if (config.empty()) return Settings().lcm.url;
  return value_or_fail(load_settings(config)).lcm.url;
}

}  // namespace scree::cli
