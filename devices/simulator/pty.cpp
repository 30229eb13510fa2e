#include "devices/simulator/pty.h"

#include <array>

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include "core/base/error.h"

namespace lumorph {

Pty::Pty() {
    int slave = -1;
    std::array<char, 128> name{};
    termios raw{};
    ::cfmakeraw(&raw);
    if (::openpty(&master_, &slave, name.data(), &raw, nullptr) != 0)
        throw DeviceError("pseudo-terminal", "the system gives none", "close programs that have many terminals open");
    ::close(slave);
    ::fcntl(master_, F_SETFL, O_NONBLOCK);
    path_ = name.data();
}

void Pty::unplug() {
    if (master_ >= 0) ::close(master_);
    master_ = -1;
}

void Pty::send(const std::vector<std::uint8_t>& bytes) const {
    if (::write(master_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
        throw DeviceError("pseudo-terminal " + path_, "it is full", "see that whoever opened it reads");
}

std::vector<std::uint8_t> Pty::receive() const {
    std::vector<std::uint8_t> all;
    std::array<std::uint8_t, 4096> bytes;
    for (ssize_t count = 0; (count = ::read(master_, bytes.data(), bytes.size())) > 0;)
        all.insert(all.end(), bytes.begin(), bytes.begin() + count);
    return all;
}

void Pty::waitForBytes(std::chrono::milliseconds atMost) const {
    pollfd bytes{master_, POLLIN, 0};
    // A terminal that nobody has open is always ready, and has nothing to say.
    if (::poll(&bytes, 1, static_cast<int>(atMost.count())) > 0 && (bytes.revents & POLLIN) == 0)
        ::usleep(static_cast<useconds_t>(1000 * atMost.count()));
}

} // namespace lumorph
