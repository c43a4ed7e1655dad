#include "unit/xsens/terminal_speed.hpp"

// Not to be had together with <stdlib.h>'s terminals.
#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <sys/ioctl.h>

namespace scree::test {

int terminal_speed(int descriptor) {
  termios2 settings{};
  if (ioctl(descriptor, TCGETS2, &settings) != 0) return -1;
  return static_cast<int>(settings.c_ospeed);
}

}  // namespace scree::test
