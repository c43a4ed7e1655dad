#include "replay/imu_terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "commands.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

/// Whether a link of ours may take its place.
bool is_replaceable(const fs::path& name) {
  std::error_code error;
  if (!fs::is_symlink(fs::symlink_status(name, error))) return false;
  return !fs::exists(name, error) ||
         fs::read_symlink(name, error).string().starts_with("/dev/pts/");
}

}  // namespace

ImuTerminal::ImuTerminal(fs::path name) : name_(std::move(name)) {
  std::error_code error;
  if (fs::exists(fs::symlink_status(name_, error)) && !is_replaceable(name_)) {
    throw Failure(name_.string() + " is there already, and no link of an earlier replay");
  }
  plug_in();
}

ImuTerminal::~ImuTerminal() {
  std::error_code error;
  if (fs::read_symlink(name_, error) == terminal_) fs::remove(name_, error);
}

void ImuTerminal::plug_in() {
  Descriptor master(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, 64> terminal{};
  if (!master.is_open() || grantpt(master.get()) != 0 || unlockpt(master.get()) != 0 ||
      ptsname_r(master.get(), terminal.data(), terminal.size()) != 0) {
    throw Failure(std::string("cannot open a pseudo-terminal: ") + std::strerror(errno));
  }
  {
    // What has never been opened does not show that nobody has it open; and what the program has
    // not yet set up must not echo.
    const Descriptor slave(::open(terminal.data(), O_RDWR | O_NOCTTY | O_CLOEXEC));
    if (!slave.is_open()) {
      throw Failure(std::string("cannot open ") + terminal.data() + ": " + std::strerror(errno));
    }
    termios settings{};
    tcgetattr(slave.get(), &settings);
    cfmakeraw(&settings);
    tcsetattr(slave.get(), TCSANOW, &settings);
    // The daemon runs as a user of its own.
    fchmod(slave.get(), 0666);
  }
  master_ = std::move(master);
  terminal_ = terminal.data();
  mti_ = SimulatedMti();
  is_open_ = false;

  fs::path fresh = name_;
  fresh += ".new";
  std::error_code error;
  fs::remove(fresh, error);
  fs::create_symlink(terminal_, fresh, error);
  if (!error) fs::rename(fresh, name_, error);
  if (error) throw Failure("cannot make the link " + name_.string() + ": " + error.message());
}

void ImuTerminal::serve(std::int64_t nanoseconds) {
  wait(nanoseconds);
  std::array<std::uint8_t, 4096> buffer;
  while (true) {
    const ssize_t size = read(master_.get(), buffer.data(), buffer.size());
    if (size < 0 && errno == EIO) {
      if (is_open_) plug_in();
      return;
    }
    is_open_ = true;
    if (size <= 0) return;
    const auto answers = mti_.take(std::span(buffer).first(static_cast<std::size_t>(size)));
    was_configured_ = was_configured_ || !mti_.is_measuring();
    // An answer that does not fit is asked for again.
    [[maybe_unused]] const ssize_t written = write(master_.get(), answers.data(), answers.size());
  }
}

void ImuTerminal::wait(std::int64_t nanoseconds) {
  // poll() returns at once while nobody has the terminal open.
  constexpr std::int64_t kLookNs = 50'000'000;
  nanoseconds = std::max(is_open_ ? nanoseconds : std::min(nanoseconds, kLookNs), std::int64_t{0});
  const timespec time{nanoseconds / 1'000'000'000, nanoseconds % 1'000'000'000};
  pollfd port{master_.get(), POLLIN, 0};
  ppoll(&port, is_open_ ? 1 : 0, &time, nullptr);
}

void ImuTerminal::send(std::span<const std::uint8_t> bytes) {
  const bool is_sent = is_listened_to() && write(master_.get(), bytes.data(), bytes.size()) ==
                                               static_cast<ssize_t>(bytes.size());
  ++(is_sent ? sent_ : lost_);
}

}  // namespace scree::cli
