#include "can_device.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

namespace scree::encoder {
namespace {

template <class T>
bool set_option(const Descriptor& socket, int level, int option, const T& value) {
  return setsockopt(socket.get(), level, option, &value, sizeof value) == 0;
}

Error reason_of(int error, const std::string& interface) {
  const std::string cannot = "cannot use CAN interface " + interface + ": ";
  switch (error) {
    case ENODEV:
      return {cannot + "there is no such interface (`ip link` lists them)"};
    case EAFNOSUPPORT:
    case EPROTONOSUPPORT:
      return {cannot + "this kernel has no SocketCAN (`modprobe can_raw`)"};
    default:
      return {cannot + std::strerror(error)};
  }
}

ifreq request_for(const std::string& interface) {
  ifreq request{};
  interface.copy(request.ifr_name, sizeof request.ifr_name - 1);
  return request;
}

bool set_filters(const Descriptor& socket, const std::optional<CanId>& only) {
  const can_err_mask_t errors = CAN_ERR_MASK;
  const int on = 1;
  if (!set_option(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors)) return false;
  if (!set_option(socket, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, on)) return false;
  if (!only) return true;
  can_filter filter{};
  filter.can_id = only->id | (only->is_extended ? CAN_EFF_FLAG : 0U);
  filter.can_mask = CAN_EFF_FLAG | (only->is_extended ? only->mask : CAN_SFF_MASK);
  return set_option(socket, SOL_CAN_RAW, CAN_RAW_FILTER, filter);
}

/// @param set_options returns whether all could be set
template <class SetOptions>
Result<Descriptor> open_interface(const std::string& interface, SetOptions set_options) {
  const auto failure = [&](int error) { return tl::make_unexpected(reason_of(error, interface)); };
  if (interface.empty() || interface.size() >= IFNAMSIZ) return failure(ENODEV);
  Descriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW));
  if (!socket.is_open()) return failure(errno);
  ifreq request = request_for(interface);
  if (ioctl(socket.get(), SIOCGIFINDEX, &request) != 0) return failure(errno);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = request.ifr_ifindex;
  if (!set_options(socket) ||
      bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return failure(errno);
  }
  return socket;
}

bool prepare_to_listen(const Descriptor& socket, const std::optional<CanId>& only) {
  const int on = 1;
  return set_option(socket, SOL_SOCKET, SO_TIMESTAMPNS, on) &&
         set_option(socket, SOL_SOCKET, SO_RXQ_OVFL, on) && set_filters(socket, only);
}

/// It hears nothing, and sends both kinds of frames.
bool prepare_to_send(const Descriptor& socket) {
  const int on = 1;
  return setsockopt(socket.get(), SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0) == 0 &&
         set_option(socket, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, on);
}

bool is_interface_up(const std::string& interface, const Descriptor& socket) {
  ifreq request = request_for(interface);
  return ioctl(socket.get(), SIOCGIFFLAGS, &request) == 0 && (request.ifr_flags & IFF_UP) != 0;
}

}  // namespace

CanSocket::Device can_device(const std::string& interface, std::optional<CanId> only) {
  const auto listen = [=](const Descriptor& socket) { return prepare_to_listen(socket, only); };
  return {[=] { return open_interface(interface, listen); },
          [=](const Descriptor& socket) { return is_interface_up(interface, socket); }};
}

Result<Descriptor> open_for_sending(const std::string& interface) {
  return open_interface(interface, prepare_to_send);
}

}  // namespace scree::encoder
