#pragma once

namespace scree::test {

/// Bit rate that a terminal is set to; -1 when it is none.
int terminal_speed(int descriptor);

}  // namespace scree::test
