#include "devices/transport/link_failsafe.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "devices/transport/failsafe_messages.h"

namespace lumorph {

namespace {

constexpr Microseconds kBeatEvery{100'000};
constexpr int kCloseMilliseconds = 200;
constexpr int kFirstFree = 16; // descriptors from here on do not meet those that the process shall have

/// A descriptor that is closed at the end.
class Descriptor {
public:
    Descriptor() = default;
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() { close(); }
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        close();
        number_ = std::exchange(other.number_, -1);
        return *this;
    }
    [[nodiscard]] int get() const noexcept { return number_; }
    void close() noexcept {
        if (const int number = std::exchange(number_, -1); number >= 0) ::close(number);
    }

private:
    int number_ = -1;
};

/// What a program is started with. posix_spawn never copies this program, whose other threads may hold any lock.
class SpawnPlan {
public:
    SpawnPlan(int device, int socket) {
        ::posix_spawn_file_actions_init(&files_);
        ::posix_spawn_file_actions_addopen(&files_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        ::posix_spawn_file_actions_addopen(&files_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
        ::posix_spawn_file_actions_addopen(&files_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
        ::posix_spawn_file_actions_adddup2(&files_, device, failsafe::kDevice);
        ::posix_spawn_file_actions_adddup2(&files_, socket, failsafe::kSocket);
        ::posix_spawn_file_actions_addclosefrom_np(&files_, failsafe::kSocket + 1);
        ::posix_spawn_file_actions_addchdir_np(&files_, "/"); // holds no folder that somebody wants to unmount
        ::posix_spawnattr_init(&attributes_);
        sigset_t none;
        sigset_t all;
        ::sigemptyset(&none);
        ::sigfillset(&all);
        ::posix_spawnattr_setsigmask(&attributes_, &none);
        ::posix_spawnattr_setsigdefault(&attributes_, &all);
        // A session of its own: what a terminal sends to its programs does not reach it.
        ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSID);
    }
    ~SpawnPlan() {
        ::posix_spawn_file_actions_destroy(&files_);
        ::posix_spawnattr_destroy(&attributes_);
    }
    SpawnPlan(const SpawnPlan&) = delete;
    SpawnPlan& operator=(const SpawnPlan&) = delete;

    /// False where it could not be started. It leaves this process at once, and is no child of it.
    [[nodiscard]] bool start(const std::string& program) const {
        std::string name = program;
        std::array<char*, 2> arguments{name.data(), nullptr};
        std::array<char*, 1> environment{nullptr};
        pid_t process = 0;
        if (::posix_spawn(&process, program.c_str(), &files_, &attributes_, arguments.data(), environment.data()) != 0)
            return false;
        int status = 0;
        while (::waitpid(process, &status, 0) < 0)
            if (errno != EINTR) return false;
        return WIFEXITED(status) && WEXITSTATUS(status) == 0;
    }

private:
    posix_spawn_file_actions_t files_{};
    posix_spawnattr_t attributes_{};
};

} // namespace

struct LinkFailsafe::Data {
    Descriptor socket;
    std::size_t report = 0;
    std::vector<std::uint8_t> release; ///< as it was sent, or shall be
    bool driven = false;               ///< by it, some servo may be under power
    bool sent = true;
    bool letGo = false;
    std::optional<Microseconds> beatAt;

    /// False where the process is gone.
    bool send(std::span<const std::uint8_t> message, bool& taken) {
        taken = ::send(socket.get(), message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL) >= 0;
        return taken || errno == EAGAIN || errno == EINTR || errno == ENOBUFS;
    }
    void passRelease() {
        if (!sent && socket.get() >= 0 && !send(release, sent)) end();
    }
    void listen() {
        std::array<std::uint8_t, 16> message{};
        while (socket.get() >= 0) {
            const ssize_t size = ::recv(socket.get(), message.data(), message.size(), MSG_DONTWAIT);
            if (size < 0 && errno == EINTR) continue;
            if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
            if (size <= 0) return end();
            letGo = letGo || message[0] == failsafe::kLetGo;
        }
    }
    /// It is gone, or shall go.
    void end() { socket.close(); }
};

LinkFailsafe::LinkFailsafe(const SharedLink& link, const std::filesystem::path& program)
    : data_(std::make_unique<Data>()) {
    data_->report = link.report;
    if (link.descriptor < 0) return;
    std::array<int, 2> pair{};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair.data()) != 0) return;
    Descriptor ours(pair[0]);
    const Descriptor theirs(pair[1]);
    const Descriptor socket(::fcntl(theirs.get(), F_DUPFD_CLOEXEC, kFirstFree));
    const Descriptor device(::fcntl(link.descriptor, F_DUPFD_CLOEXEC, kFirstFree));
    if (socket.get() < 0 || device.get() < 0) return;
    if (SpawnPlan(device.get(), socket.get()).start(program.string())) data_->socket = std::move(ours);
}

LinkFailsafe::~LinkFailsafe() {
    if (data_->socket.get() < 0) return;
    data_->passRelease();
    ::shutdown(data_->socket.get(), SHUT_WR);
    // Its end of the pair closes with the process, after the device.
    pollfd end{data_->socket.get(), POLLIN, 0};
    if (!data_->driven) (void)::poll(&end, 1, kCloseMilliseconds);
    data_->end();
}

bool LinkFailsafe::runs() const noexcept { return data_->socket.get() >= 0; }

void LinkFailsafe::setRelease(const std::vector<std::vector<std::uint8_t>>& messages, Microseconds gap) {
    const auto number = [](std::vector<std::uint8_t>& to, std::size_t value) {
        to.push_back(static_cast<std::uint8_t>(value & 0xFFU));
        to.push_back(static_cast<std::uint8_t>(value >> 8U));
    };
    std::vector<std::uint8_t> release{failsafe::kRelease};
    number(release, static_cast<std::size_t>(std::clamp<std::int64_t>(gap.count() / 1000, 1, 1000)));
    for (const std::vector<std::uint8_t>& message : messages) {
        std::vector<std::uint8_t> whole;
        if (data_->report > 0) whole.push_back(0); // the number of the report, which has none
        whole.insert(whole.end(), message.begin(), message.end());
        if (data_->report > 0) whole.resize(data_->report + 1);
        number(release, whole.size());
        release.insert(release.end(), whole.begin(), whole.end());
    }
    if (release == data_->release || !runs() || release.size() > failsafe::kMostBytes) return;
    data_->release = std::move(release);
    data_->driven = !messages.empty();
    data_->sent = false;
    data_->beatAt.reset();
    data_->passRelease();
}

void LinkFailsafe::beat(Microseconds now) {
    data_->passRelease();
    if (!runs() || !data_->driven || (data_->beatAt && now >= *data_->beatAt && now - *data_->beatAt < kBeatEvery))
        return;
    data_->beatAt = now;
    bool taken = false; // one that is not has many before it
    if (runs() && !data_->send(std::span(&failsafe::kBeat, 1), taken)) data_->end();
}

bool LinkFailsafe::takeLetGo() {
    data_->listen();
    return std::exchange(data_->letGo, false);
}

std::filesystem::path failsafeProgram() {
    std::error_code unreadable;
    return std::filesystem::read_symlink("/proc/self/exe", unreadable).parent_path() / failsafe::kProgram;
}

} // namespace lumorph
