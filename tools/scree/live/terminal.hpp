#pragma once

#include <memory>

#include "live/top_page.hpp"

namespace scree::cli {

/// The terminal that the program runs in, taken over until this is destroyed (ncurses).
class Terminal {
public:
  /// Throws Failure where standard output is no terminal, or one that ncurses does not know.
  Terminal();

  int rows() const;
  int columns() const;
  void draw(const Page& page);
  /// A key that was pressed since the last call, or 0. Never waits.
  int key();

private:
  struct Close {
    void operator()(void* screen) const;
  };
  std::unique_ptr<void, Close> screen_;
};

}  // namespace scree::cli
