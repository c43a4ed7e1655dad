#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "scree/core/descriptor.hpp"
#include "simulator/mti.hpp"

namespace scree::cli {

/// An IMU on a pseudo-terminal, which another program opens under a name of our choice. It answers
/// the program's start of an MTi; what it is given to send goes out while the program listens.
///
/// When the program closes the terminal a new one takes its place, as if the IMU had been plugged
/// in again: the lock that a program has put on a terminal outlives it.
class ImuTerminal {
public:
  /// Makes `name` a symbolic link to the terminal. Throws Failure where something else has the name
  /// already; a link to a terminal that has gone is replaced.
  explicit ImuTerminal(std::filesystem::path name);
  ~ImuTerminal();
  ImuTerminal(const ImuTerminal&) = delete;
  ImuTerminal& operator=(const ImuTerminal&) = delete;

  /// Answers what the program asks, and sees whether it is still there; for at most this long, or
  /// until it asks for something.
  void serve(std::int64_t nanoseconds);
  /// Lost while nobody has the terminal open, while the IMU is being configured, and where the
  /// program does not read.
  void send(std::span<const std::uint8_t> bytes);

  bool is_open() const { return is_open_; }
  /// A program has opened it and does not configure it.
  bool is_listened_to() const { return is_open_ && mti_.is_measuring(); }
  /// Whether a program has ever told it to be configured.
  bool was_configured() const { return was_configured_; }

  std::string name() const { return name_.string(); }
  std::uint64_t sent() const { return sent_; }
  std::uint64_t lost() const { return lost_; }

private:
  void plug_in();
  void wait(std::int64_t nanoseconds);

  std::filesystem::path name_, terminal_;
  Descriptor master_;
  SimulatedMti mti_;
  bool is_open_ = false, was_configured_ = false;
  std::uint64_t sent_ = 0, lost_ = 0;
};

}  // namespace scree::cli
