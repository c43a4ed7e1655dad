#include "log_format.hpp"

#include <spdlog/pattern_formatter.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <sstream>
#include <utility>

#include "service_manager.hpp"

namespace scree {
namespace {

/// The level as in sd-daemon(3).
class JournalLevel final : public spdlog::custom_flag_formatter {
public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& line) override {
    const char level = message.level >= spdlog::level::critical ? '2'
                       : message.level == spdlog::level::err    ? '3'
                       : message.level == spdlog::level::warn   ? '4'
                       : message.level == spdlog::level::info   ? '6'
                                                                : '7';
    line.push_back('<');
    line.push_back(level);
    line.push_back('>');
  }
  std::unique_ptr<spdlog::custom_flag_formatter> clone() const override {
    return std::make_unique<JournalLevel>();
  }
};

}  // namespace

Log::Log() : writer_(LogWriter::start(STDERR_FILENO)) {
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("screed", writer_));
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  if (service_manager::logs_to_journal()) {
    formatter->add_flag<JournalLevel>('*').set_pattern("%*%v");
  } else {
    formatter->set_pattern("%H:%M:%S.%e %l: %v");
  }
  spdlog::set_formatter(std::move(formatter));
}

Log::~Log() {
  writer_->finish(std::chrono::milliseconds(500));
}

void Log::failed(const std::string& reason) {
  const char* prefix = service_manager::logs_to_journal() ? "<3>" : "screed: ";
  std::istringstream lines(reason);
  for (std::string line; std::getline(lines, line);) writer_->write(prefix + line + '\n');
}

}  // namespace scree
