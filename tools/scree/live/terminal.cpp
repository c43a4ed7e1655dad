#include "live/terminal.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "commands.hpp"

#define NCURSES_NOMACROS
#include <curses.h>
#undef OK  // which a health_t has too

namespace scree::cli {
namespace {

short pair_of(Tone tone) {
  return static_cast<short>(static_cast<int>(tone) + 1);
}

attr_t attributes_of(Tone tone) {
  const attr_t bold = tone == Tone::heading || tone == Tone::bad ? A_BOLD : A_NORMAL;
  const attr_t colour = has_colors() ? static_cast<attr_t>(COLOR_PAIR(pair_of(tone))) : A_NORMAL;
  return bold | colour;
}

}  // namespace

Terminal::Terminal() {
  if (isatty(STDOUT_FILENO) == 0 || isatty(STDIN_FILENO) == 0) {
    throw Failure("top needs a terminal; `scree watch` prints the same as lines");
  }
  SCREEN* screen = newterm(nullptr, stdout, stdin);
  if (screen == nullptr) {
    const char* name = std::getenv("TERM");
    throw Failure(std::string("the terminal is not known: TERM is ") + (name ? name : "not set"));
  }
  screen_.reset(screen);
  cbreak();
  noecho();
  curs_set(0);
  nodelay(stdscr, true);
  keypad(stdscr, true);
  if (!has_colors()) return;
  start_color();
  use_default_colors();
  constexpr short kNone = -1;
  init_pair(pair_of(Tone::plain), kNone, kNone);
  init_pair(pair_of(Tone::heading), COLOR_CYAN, kNone);
  init_pair(pair_of(Tone::good), COLOR_GREEN, kNone);
  init_pair(pair_of(Tone::warning), COLOR_YELLOW, kNone);
  init_pair(pair_of(Tone::bad), COLOR_RED, kNone);
}

void Terminal::Close::operator()(void* screen) const {
  endwin();
  delscreen(static_cast<SCREEN*>(screen));
}

int Terminal::rows() const {
  return getmaxy(stdscr);
}

int Terminal::columns() const {
  return getmaxx(stdscr);
}

void Terminal::draw(const Page& page) {
  erase();
  for (const Piece& piece : page) {
    attrset(static_cast<int>(attributes_of(piece.tone)));
    mvaddstr(piece.row, piece.column, piece.text.c_str());
  }
  refresh();
}

int Terminal::key() {
  const int key = getch();
  return key == ERR ? 0 : key;
}

}  // namespace scree::cli
