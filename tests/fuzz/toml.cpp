// A configuration. What is accepted can be written and read again.
#include "memory_file.hpp"
#include "scree/config/configuration.hpp"
#include "scree/config/settings.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  const auto settings = scree::parse_settings(text, "fuzz.toml");
  if (!settings) {
    scree::fuzz::require(!settings.error().message.empty());
    return 0;
  }
  scree::Configuration configuration;
  configuration.settings = *settings;
  const std::string written = effective_toml(configuration, scree::Shown::all);
  const auto again = scree::parse_settings(written, "again.toml");
  scree::fuzz::require(again && toml_values(*again) == toml_values(*settings));
  return 0;
}
