#pragma once

#include <lcm/lcm.h>

#include <memory>
#include <string>

#include "scree/core/result.hpp"

namespace scree {

struct DestroyLcm {
  void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
};
using LcmHandle = std::unique_ptr<lcm_t, DestroyLcm>;

/// Opens one of LCM's providers. The error comes after 3 s at the latest: liblcm waits without an
/// end for a server of tcpq that takes a connection and does not answer.
Result<LcmHandle> open_lcm(const std::string& url);

}  // namespace scree
