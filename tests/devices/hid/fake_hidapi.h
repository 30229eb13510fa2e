#pragma once

#include <cstdint>
#include <deque>
#include <list>
#include <mutex>
#include <string>
#include <vector>

namespace lumorph {

/// A USB device on the fake bus.
struct FakeHidDevice {
    std::string path = "/dev/hidraw-none0";
    std::uint16_t vendor = 0x0483;
    std::uint16_t product = 0x5750;
    std::wstring serialNumber = L"S1";
    std::wstring productText = L"LOBOT xArm";
    int usages = 1;          ///< hidapi lists a device once for each of them
    std::string openError{}; ///< not empty: it cannot be opened, and this is why
    bool unplugged = false;  ///< reads and writes give -1
    bool deafForNow = false; ///< writes hang until it is false
    std::deque<std::vector<std::uint8_t>> toRead{};
    std::vector<std::vector<std::uint8_t>> written{};
};

/// What the definitions of hid_* in this program speak to. Any thread.
struct FakeHidBus {
    std::mutex mutex;
    std::list<FakeHidDevice> devices; ///< handles point into it, so nothing is removed while one is open
    int open = 0;                     ///< handles
    int reads = 0;
    std::wstring error;
};

FakeHidBus& fakeHidBus();

} // namespace lumorph
