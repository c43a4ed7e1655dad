#pragma once

#include <cstdint>

#include "scree/drivers/xsens/measurement.hpp"
#include "scree/drivers/xsens/refusal.hpp"

namespace scree::xsens {

struct ItemCounts {
  std::uint64_t decoded = 0;
  std::uint64_t unknown = 0;  ///< of an id that the manuals do not have, passed over by their size
  RefusalCounts refused{};
};

/// Reads the data of an MTData2 message (MT0101P, section "MTData2"). An item that is refused is
/// absent; what else the message holds is read. Any bytes are safe.
Measurement decode_mt_data2(Bytes data, ItemCounts& counts);

}  // namespace scree::xsens
