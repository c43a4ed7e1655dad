#include "view/hub.hpp"

namespace scree::cli {

void Hub::say(Kind kind, std::string_view json) {
  const std::scoped_lock lock(mutex_);
  Event& event = events_[static_cast<std::size_t>(kind)];
  ++event.number;
  event.json = json;
  changed_.notify_all();
}

bool Hub::has_news(const Seen& seen) const {
  for (std::size_t i = 0; i < events_.size(); ++i) {
    if (events_[i].number != seen[i]) return true;
  }
  return false;
}

std::string Hub::next(Seen& seen, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] { return is_closed_ || has_news(seen); });
  std::string text;
  for (std::size_t i = 0; i < events_.size() && !is_closed_; ++i) {
    if (events_[i].number == seen[i]) continue;
    seen[i] = events_[i].number;
    text.append("event: ")
        .append(kKinds[i])
        .append("\ndata: ")
        .append(events_[i].json)
        .append("\n\n");
  }
  return text;
}

void Hub::close() {
  const std::scoped_lock lock(mutex_);
  is_closed_ = true;
  changed_.notify_all();
}

bool Hub::is_closed() const {
  const std::scoped_lock lock(mutex_);
  return is_closed_;
}

}  // namespace scree::cli
