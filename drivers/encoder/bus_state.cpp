#include "scree/drivers/encoder/bus_state.hpp"

#include <linux/can/error.h>

#include <cerrno>

namespace scree::encoder {

void BusMonitor::take(const CanFrame& frame) {
  if (frame.is_error) return take_error(frame);
  ++counters_.frames;
  // A frame proves that the bus works; that errors have become fewer is said by an error frame.
  if (state_ != BusState::warning && state_ != BusState::passive) state_ = BusState::active;
}

void BusMonitor::take_error(const CanFrame& frame) {
  ++counters_.error_frames;
  const auto has = [&](std::uint32_t kind) { return (frame.id & kind) != 0; };
  if (has(CAN_ERR_LOSTARB)) ++counters_.lost_arbitrations;
  if (has(CAN_ERR_PROT)) ++counters_.protocol_errors;
  if (has(CAN_ERR_ACK)) ++counters_.missing_acknowledges;
  if (has(CAN_ERR_CRTL)) take_controller(frame.size > 1 ? frame.data[1] : std::uint8_t{0});
  if (has(CAN_ERR_RESTARTED)) {
    ++counters_.restarts;
    state_ = BusState::active;
  }
  if (has(CAN_ERR_BUSOFF)) {
    ++counters_.bus_off;
    state_ = BusState::bus_off;
  }
}

void BusMonitor::take_controller(std::uint8_t problem) {
  const auto has = [&](int bits) { return (problem & bits) != 0; };
  if (has(CAN_ERR_CRTL_RX_OVERFLOW)) ++counters_.overflows;
  if (has(CAN_ERR_CRTL_ACTIVE)) state_ = BusState::active;
  if (has(CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) state_ = BusState::warning;
  if (has(CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) state_ = BusState::passive;
}

void BusMonitor::failed(int error) {
  const bool is_down = error == ENETDOWN;
  ++(is_down ? counters_.downs : counters_.removals);
  state_ = is_down ? BusState::down : BusState::absent;
}

void BusMonitor::is_up() {
  if (state_ == BusState::down || state_ == BusState::absent) state_ = BusState::silent;
}

}  // namespace scree::encoder
