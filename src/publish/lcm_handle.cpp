#include "scree/publish/lcm_handle.hpp"

#include <chrono>
#include <future>
#include <thread>
#include <utility>

namespace scree {

Result<LcmHandle> open_lcm(const std::string& url) {
  constexpr std::chrono::seconds kLongest{3};
  std::promise<LcmHandle> promise;
  std::future<LcmHandle> opened = promise.get_future();
  // Detached: one that still waits cannot be called back.
  std::thread([url, promise = std::move(promise)]() mutable {
    promise.set_value(LcmHandle(lcm_create(url.c_str())));
  }).detach();
  LcmHandle handle;
  if (opened.wait_for(kLongest) == std::future_status::ready) handle = opened.get();
  if (!handle) return fail("LCM cannot open " + url + ": is there a server that answers?");
  return handle;
}

}  // namespace scree
