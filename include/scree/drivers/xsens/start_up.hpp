#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "scree/config/settings.hpp"
#include "scree/drivers/xsens/framing.hpp"

namespace scree::xsens {

/// Why the configured outputs do not fit through the configured line; nothing when they do.
std::optional<std::string> line_too_slow(const ImuSettings& settings);

/// Brings an MTi into measurement with the configured outputs (MT0101P, sections "States" and
/// "Messages"). Only the protocol: bytes and time in, bytes to send and the line's bit rate out.
///
/// | step       | sent                         | then                                            |
/// |------------|------------------------------|-------------------------------------------------|
/// | find       | GoToConfig                   | at the configured bit rate, then at the usual   |
/// |            |                              | ones, until the device acknowledges             |
/// | identify   | ReqDID                       | its id is kept                                  |
/// | set_baud   | SetBaudrate                  | only when found at another bit rate             |
/// | restart    | Reset                        | which makes the new bit rate count              |
/// | find_again | GoToConfig                   | at the configured bit rate, while it starts     |
/// | set_output | SetOutputConfiguration       | its answer says what it will really send        |
/// | go         | GoToMeasurement              | measuring                                       |
///
/// What is not acknowledged in time is sent again, a few times; then, or when the device answers
/// with an error, the start has failed. Data are an acknowledgement of GoToMeasurement, too.
class StartUp {
public:
  enum class State : std::uint8_t { working, measuring, failed };

  explicit StartUp(const ImuSettings& settings);

  /// Starts from the first step. Times are of any clock that is never set.
  void begin(std::int64_t now_ns);
  /// Takes what was read from the line. Any bytes are safe.
  void take(Bytes bytes, std::int64_t now_ns);
  /// Sends again or gives up what has waited for too long.
  void advance(std::int64_t now_ns);

  /// What the line has to run at before anything is sent.
  int baud() const { return baud_; }
  /// What is to be sent now, once; empty when nothing is.
  Bytes take_output();
  /// When advance() has to be called at the latest.
  std::int64_t due_ns() const { return due_ns_; }

  State state() const { return state_; }
  /// Why it failed, one sentence.
  const std::string& problem() const { return problem_; }
  /// What the device does otherwise than it was told, one sentence; mostly empty.
  const std::string& note() const { return note_; }
  /// 0 until it is known.
  std::uint64_t device_id() const { return device_id_; }

private:
  enum class Step : std::uint8_t { find, identify, set_baud, restart, find_again, set_output, go };
  struct Request {
    MessageId id;
    const char* name;
    std::int64_t patience_ns;
    int tries;
  };
  static const Request& request_of(Step step);

  void enter(Step step, std::int64_t now_ns);
  void try_step(std::int64_t now_ns);
  void give_up(std::int64_t now_ns);
  void take_message(const Message& message, std::int64_t now_ns);
  void acknowledged(Bytes data, std::int64_t now_ns);
  void compare_outputs(Bytes data);
  void fail(std::string problem);
  void send(MessageId id, Bytes data);

  ImuSettings settings_;
  State state_ = State::failed;
  Step step_ = Step::find;
  int tries_ = 0;
  std::size_t next_rate_ = 0;  ///< of the usual bit rates, to be tried after this one
  int baud_;
  std::int64_t due_ns_ = 0;
  Framer framer_;
  std::array<std::uint8_t, 128> output_{};
  std::size_t output_size_ = 0;
  std::uint64_t device_id_ = 0;
  std::string refusal_;  ///< of this step; empty: none
  std::string problem_, note_;
};

}  // namespace scree::xsens
