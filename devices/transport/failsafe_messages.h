#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

/// What a link and its failsafe process (failsafe_program.cpp) say to each other: one message a datagram of a pair of
/// SOCK_SEQPACKET sockets. The end of the pair is a message too: the program has ended.
namespace lumorph::failsafe {

// Descriptors that the process is started with; it has no others.
constexpr int kDevice = 3;
constexpr int kSocket = 4;

constexpr std::uint8_t kBeat = 'b'; ///< to the process: the link's thread works
/// To the process: what lets the servos go from now on. Two bytes, the low one first, of milliseconds between two times
/// that it is written; then each message after two bytes of its length. No messages: no servo is under power.
constexpr std::uint8_t kRelease = 'r';
constexpr std::uint8_t kLetGo = 'l'; ///< from the process: there was no beat; it begins to let the servos go

constexpr std::chrono::milliseconds kNoBeat{1000}; ///< after so long without a beat servos are let go
constexpr std::size_t kMostBytes = 8192;           ///< of a message

/// The first 15 characters of the program's name, which is what Linux shows of it.
constexpr const char* kProgram = "lumorph-servo-failsafe";
constexpr const char* kShortName = "lumorph-servo-f";

} // namespace lumorph::failsafe
