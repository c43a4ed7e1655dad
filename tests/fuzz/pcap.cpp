// A capture: pcap or pcapng, frames of any link type, IP fragments, UDP.
#include "memory_file.hpp"
#include "scree/capture/pcap_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const scree::fuzz::MemoryFile file(bytes, size);
  if (auto reader = scree::PcapReader::open(file.name())) {
    std::size_t payload = 0;
    for (scree::Datagram datagram; reader->next(datagram);) {
      for (const std::uint8_t byte : datagram.payload) payload += byte;
    }
    scree::fuzz::require(payload < SIZE_MAX);
  }
  if (auto reader = scree::PcapReader::open(file.name())) {
    for (scree::PcapRecord record; reader->next(record);) {
      scree::fuzz::require(record.bytes.size() <= size);
    }
  }
  return 0;
}
