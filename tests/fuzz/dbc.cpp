// A DBC file, and the name of a signal in front of it.
#include <string_view>

#include "memory_file.hpp"
#include "scree/drivers/encoder/dbc.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  // Without a byte behind it, so that a look beyond the end is seen.
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  const std::size_t line = text.find('\n');
  const std::string_view dbc(text);
  const bool has_name = line != std::string::npos && line < 60;
  const auto signal = scree::encoder::find_signal(has_name ? dbc.substr(line + 1) : dbc,
                                                  has_name ? dbc.substr(0, line) : "M.S", "f");
  if (signal) {
    scree::fuzz::require(signal->length > 0 && signal->length <= 64 && signal->start_bit >= 0);
  }
  return 0;
}
