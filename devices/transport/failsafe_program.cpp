// lumorph-servo-failsafe: lets the servos of one board go when the program that drives them has ended or is stuck. A
// LinkFailsafe starts it with a copy of the link's descriptor and one end of a pair of sockets. It knows no protocol:
// what it writes came from the board's controller. While the program lives and beats it writes nothing. It holds no
// file but those two, its memory is locked and it ignores what ends others: a disk that hangs, a full memory or a
// terminal that closes does not keep it from its work.

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include "core/base/thread_priority.h"
#include "devices/transport/failsafe_messages.h"

namespace {

using namespace lumorph::failsafe;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kRepeatFor{500}; // no board acknowledges it, and a line may lose bytes
constexpr int kLeastTimes = 4;
constexpr milliseconds kWriteWithin{100}; // what a line has not taken by then stands in the way and is dropped
constexpr milliseconds kLeastGap{5};

int millisecondsUntil(Clock::time_point time) {
    const auto left = std::chrono::ceil<milliseconds>(time - Clock::now());
    return static_cast<int>(std::max<milliseconds::rep>(left.count(), 0));
}

/// Whether the device takes bytes within the time.
bool takesBytes() {
    pollfd device{kDevice, POLLOUT, 0};
    return ::poll(&device, 1, static_cast<int>(kWriteWithin.count())) > 0 && (device.revents & POLLOUT) != 0;
}

/// A whole message. What waits in the system before it is dropped only where the line takes nothing more: the program
/// keeps that to a few bytes, and a message that is cut would be finished by this one.
void write(const std::vector<std::uint8_t>& message) {
    std::size_t done = 0;
    for (bool emptied = false; done < message.size();) {
        if (!takesBytes()) {
            if (emptied || ::tcflush(kDevice, TCOFLUSH) != 0) return;
            emptied = true;
            done = 0;
            continue;
        }
        const ssize_t count = ::write(kDevice, message.data() + done, message.size() - done);
        if (count > 0)
            done += static_cast<std::size_t>(count);
        else if (count < 0 && errno != EINTR && errno != EAGAIN)
            return;
    }
}

class Watch {
public:
    /// Returns when there is nothing more to do.
    void run() {
        while (!deviceGone_ && !(programGone_ && !letting_)) {
            wait();
            listen();
            if (!letting_ && mustLetGo()) begin();
            if (letting_ && Clock::now() >= next_) letGo();
        }
    }

private:
    [[nodiscard]] bool mustLetGo() const {
        return !messages_.empty() && !told_ && (programGone_ || Clock::now() - beat_ >= kNoBeat);
    }
    void wait() {
        int time = -1;
        if (letting_)
            time = millisecondsUntil(next_);
        else if (!messages_.empty() && !told_)
            time = millisecondsUntil(beat_ + kNoBeat);
        std::array<pollfd, 2> files{{{programGone_ ? -1 : kSocket, POLLIN, 0}, {kDevice, 0, 0}}};
        if (::poll(files.data(), files.size(), time) <= 0) return;
        deviceGone_ = (files[1].revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
    }
    /// All that was said. Whatever waited while this process had no processor counts as said now.
    void listen() {
        while (!programGone_) {
            const ssize_t size = ::recv(kSocket, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
            if (size < 0 && errno == EINTR) continue;
            if (size < 0 && errno == EAGAIN) return;
            if (size <= 0) {
                programGone_ = true;
                told_ = false; // what was let go after a hang is let go once more
                return;
            }
            beat_ = Clock::now();
            // The program runs again, and takes over.
            letting_ = told_ = false;
            if (buffer_[0] == kRelease) take(static_cast<std::size_t>(size));
        }
    }
    [[nodiscard]] std::size_t number(std::size_t at) const {
        return buffer_[at] + 256U * static_cast<std::size_t>(buffer_[at + 1]);
    }
    void take(std::size_t size) {
        messages_.clear();
        if (size < 3) return;
        gap_ = std::max(milliseconds(number(1)), kLeastGap);
        for (std::size_t at = 3; at + 2 <= size;) {
            const std::size_t end = at + 2 + number(at);
            if (end > size) return;
            messages_.emplace_back(buffer_.begin() + static_cast<std::ptrdiff_t>(at + 2),
                                   buffer_.begin() + static_cast<std::ptrdiff_t>(end));
            at = end;
        }
    }
    void begin() {
        // Before the first byte: a program that goes on at this moment must not go on driving them.
        if (!programGone_) (void)::send(kSocket, &kLetGo, 1, MSG_DONTWAIT | MSG_NOSIGNAL);
        letting_ = told_ = true;
        times_ = 0;
        next_ = Clock::now();
        until_ = next_ + kRepeatFor;
    }
    void letGo() {
        if (times_ >= kLeastTimes && Clock::now() >= until_) {
            letting_ = false;
            return;
        }
        for (const std::vector<std::uint8_t>& message : messages_) write(message);
        ++times_;
        next_ = Clock::now() + gap_;
    }

    std::array<std::uint8_t, kMostBytes> buffer_{};
    std::vector<std::vector<std::uint8_t>> messages_; ///< that let the servos go
    milliseconds gap_{25};
    Clock::time_point beat_ = Clock::now();
    bool programGone_ = false;
    bool deviceGone_ = false;
    bool letting_ = false;
    bool told_ = false; ///< they were let go since the last beat
    int times_ = 0;
    Clock::time_point next_, until_;
};

} // namespace

int main() {
    int type = 0;
    socklen_t size = sizeof type;
    if (::fcntl(kDevice, F_GETFD) < 0 || ::getsockopt(kSocket, SOL_SOCKET, SO_TYPE, &type, &size) != 0) {
        std::fputs("lumorph-servo-failsafe: Lumorph starts it with each servo controller; there is nothing to start by "
                   "hand\n",
                   stderr);
        return 2;
    }
    // No child of Lumorph's, which would have to wait for its end.
    if (const pid_t process = ::fork(); process != 0) return process > 0 ? 0 : 1;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGTSTP, SIGTTOU, SIGUSR1, SIGUSR2, SIGALRM})
        (void)::signal(signal, SIG_IGN);
    (void)::mlockall(MCL_CURRENT | MCL_FUTURE);
    (void)lumorph::runPromptly();
    Watch().run();
    return 0;
}
