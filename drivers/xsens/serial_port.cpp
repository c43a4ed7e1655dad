#include "scree/drivers/xsens/serial_port.hpp"

// The kernel's own termios2 knows any bit rate; it cannot be had together with <termios.h>.
#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <fcntl.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "scree/core/nanoseconds.hpp"

namespace scree::xsens {
namespace {

std::string reason_of(int error, const std::string& device) {
  switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return "the serial port " + device + " is not there: is the IMU plugged in?";
    case EACCES:
    case EPERM:
      return "cannot open the serial port " + device +
             ": no right to (its group, mostly dialout, has it)";
    case EBUSY:
    case EWOULDBLOCK:
      return "the serial port " + device + " is in use by another program";
    case ENOTTY:
    case EISDIR:
      return device + " is no serial port";
    default:
      return "cannot open the serial port " + device + ": " + std::strerror(error);
  }
}

/// Has the driver hand on bytes at once, where it can: an FTDI adapter else keeps them for 16 ms.
void ask_for_low_latency(int port) {
  serial_struct settings{};
  if (ioctl(port, TIOCGSERIAL, &settings) != 0) return;
  settings.flags |= static_cast<int>(ASYNC_LOW_LATENCY);
  ioctl(port, TIOCSSERIAL, &settings);
}

}  // namespace

Result<SerialPort> SerialPort::open(const std::string& device, int baud) {
  SerialPort port;
  port.device_ = device;
  port.port_ = Descriptor(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  const int descriptor = port.port_.get();
  if (descriptor < 0) return fail(reason_of(errno, device));
  // The terminal's own lock does not stop a privileged program, the file's does.
  if (ioctl(descriptor, TIOCEXCL) != 0 || flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    return fail(reason_of(errno, device));
  }
  ask_for_low_latency(descriptor);
  if (const auto set = port.set_baud(baud); !set) return tl::make_unexpected(set.error());
  return port;
}

Result<void> SerialPort::set_baud(int baud) {
  termios2 settings{};
  const int port = port_.get();
  if (ioctl(port, TCGETS2, &settings) != 0) return fail(reason_of(errno, device_));
  settings.c_iflag = 0;
  settings.c_oflag = 0;
  settings.c_lflag = 0;
  settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | BOTHER << IBSHIFT;
  settings.c_ispeed = settings.c_ospeed = static_cast<speed_t>(baud);
  // So that a read without bytes says EAGAIN, and 0 is left for a port that has gone.
  settings.c_cc[VMIN] = 1;
  settings.c_cc[VTIME] = 0;
  termios2 real{};
  if (ioctl(port, TCSETS2, &settings) != 0 || ioctl(port, TCGETS2, &real) != 0) {
    return fail("cannot set the serial port " + device_ + " to " + std::to_string(baud) +
                " bit/s: " + std::strerror(errno));
  }
  constexpr int kTolerance = 33;  // a thirty-third: 3 %
  if (std::abs(static_cast<int>(real.c_ospeed) - baud) > baud / kTolerance) {
    return fail("the serial port " + device_ + " cannot do " + std::to_string(baud) + " bit/s");
  }
  ioctl(port, TCFLSH, TCIOFLUSH);
  return {};
}

SerialPort::Reading SerialPort::receive(std::span<std::uint8_t> buffer, ReceivedBytes& received) {
  ssize_t size = -1;
  do {
    size = ::read(port_.get(), buffer.data(), buffer.size());
  } while (size < 0 && errno == EINTR);
  if (size > 0) {
    received = {buffer.first(static_cast<std::size_t>(size)), read_clock(CLOCK_REALTIME)};
    return Reading::bytes;
  }
  if (size == 0 || (errno != EAGAIN && errno != EWOULDBLOCK)) return Reading::lost;
  // Some drivers say EAGAIN for ever after an unplugging that poll() knows of.
  pollfd port{port_.get(), 0, 0};
  poll(&port, 1, 0);
  return (port.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0 ? Reading::lost : Reading::nothing;
}

bool SerialPort::send(std::span<const std::uint8_t> bytes) {
  return write(port_.get(), bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
}

}  // namespace scree::xsens
