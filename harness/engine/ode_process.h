#pragma once

#include <cstdint>
#include <string>

namespace parallax::harness {

/// Brings the engine up once per process and gives the calling thread its data. Cheap when done
/// already; call it at the start of everything that touches the engine.
void enter_ode();

/// "0.16.2"
std::string ode_version();

/// Seeds the engine's generator, of which there is one per process.
void seed_ode(std::uint64_t seed);

/// While one exists, messages that the engine prints on this thread are counted into `count`
/// instead. They come from the solver of contact forces and are harmless when rare.
class MessageCounter {
 public:
  explicit MessageCounter(std::int64_t& count);
  ~MessageCounter();
  MessageCounter(const MessageCounter&) = delete;
  MessageCounter& operator=(const MessageCounter&) = delete;

 private:
  std::int64_t* previous_;
};

}  // namespace parallax::harness
