#include "simulator/xbus.hpp"

#include <bit>
#include <type_traits>

namespace scree {
namespace {

using namespace xsens;

class Data {
public:
  template <class T>
  void put(T value) {
    using Bits = std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint32_t>;
    static_assert(sizeof(T) == sizeof(Bits));
    const auto bits = std::bit_cast<Bits>(value);
    for (std::size_t i = sizeof(Bits); i-- > 0;) {
      bytes_.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
    }
  }
  void begin(DataId id, std::size_t size) {
    put(static_cast<std::uint16_t>(id));
    bytes_.push_back(static_cast<std::uint8_t>(size));
  }
  void put(const Eigen::Vector3d& vector) {
    for (const double value : vector) put(static_cast<float>(value));
  }
  std::span<const std::uint8_t> bytes() const { return bytes_; }

private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

std::vector<std::uint8_t> xbus_message(MessageId id, std::span<const std::uint8_t> data) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(data.size() + 5);
  for (const std::uint8_t byte : {kPreamble, kMasterDevice, static_cast<std::uint8_t>(id),
                                  static_cast<std::uint8_t>(data.size())}) {
    bytes.push_back(byte);
  }
  bytes.insert(bytes.end(), data.begin(), data.end());
  unsigned sum = 0;
  for (std::size_t i = 1; i < bytes.size(); ++i) sum += bytes[i];
  bytes.push_back(static_cast<std::uint8_t>(0x100U - (sum & 0xFFU)));
  return bytes;
}

std::vector<std::uint8_t> mt_data2(const ImuMessage& sample) {
  Data data;
  data.begin(DataId::packet_counter, 2);
  data.put(sample.packet_counter);
  data.begin(DataId::sample_time_fine, 4);
  data.put(sample.sample_time_fine);
  if (sample.has_orientation) {
    data.begin(DataId::quaternion, 16);
    data.put(static_cast<float>(sample.orientation.w()));
    data.put(Eigen::Vector3d(sample.orientation.vec()));
  }
  data.begin(DataId::acceleration, 12);
  data.put(sample.acceleration);
  data.begin(DataId::rate_of_turn, 12);
  data.put(sample.rate_of_turn);
  data.begin(DataId::status_word, 4);
  data.put(sample.status);
  return xbus_message(MessageId::mt_data2, data.bytes());
}

}  // namespace scree
