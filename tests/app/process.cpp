#include "tests/app/process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace lumorph::test {

namespace {

using Clock = std::chrono::steady_clock;

void require(bool good, const char* what) {
    if (!good) throw std::system_error(errno, std::generic_category(), what);
}

/// Two ends of a channel: what the program writes to, and what the test reads from.
struct Channel {
    int write = -1;
    int read = -1;
};

Channel pipeChannel() {
    std::array<int, 2> ends{};
    require(pipe2(ends.data(), O_CLOEXEC) == 0, "pipe2");
    return {ends[1], ends[0]};
}

Channel terminalChannel() {
    Channel channel;
    channel.read = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    require(channel.read >= 0 && grantpt(channel.read) == 0 && unlockpt(channel.read) == 0, "posix_openpt");
    channel.write = open(ptsname(channel.read), O_RDWR | O_NOCTTY | O_CLOEXEC);
    require(channel.write >= 0, "ptsname");
    return channel;
}

/// An unnamed file holding the whole input, read from its beginning.
int inputOf(const std::string& text) {
    std::FILE* file = std::tmpfile();
    require(file != nullptr, "tmpfile");
    std::fwrite(text.data(), 1, text.size(), file);
    std::fflush(file);
    const int descriptor = fcntl(fileno(file), F_DUPFD_CLOEXEC, 3);
    std::fclose(file);
    require(descriptor >= 0 && lseek(descriptor, 0, SEEK_SET) == 0, "standard input");
    return descriptor;
}

/// False once there is nothing more to come.
bool readSome(int& descriptor, std::string& into) {
    std::array<char, 65536> chunk{};
    const ssize_t got = read(descriptor, chunk.data(), chunk.size());
    if (got > 0) {
        into.append(chunk.data(), static_cast<std::size_t>(got));
        return true;
    }
    close(descriptor); // a terminal whose program has ended gives EIO rather than 0
    descriptor = -1;
    return false;
}

} // namespace

nlohmann::json Outcome::json() const { return nlohmann::json::parse(out); }

Process::Process(const std::string& program, const std::vector<std::string>& arguments, const std::string& input,
                 ErrorStream errors) {
    const int in = inputOf(input);
    const Channel out = pipeChannel();
    const Channel err = errors == ErrorStream::pipe ? pipeChannel() : terminalChannel();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out.write, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err.write, STDERR_FILENO);
    // A test that runs in the background may have inherited ignored signals; the program must not.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGHUP);
    sigaddset(&signals, SIGPIPE);
    posix_spawnattr_setsigdefault(&attributes, &signals);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    errno = posix_spawn(&process_, program.c_str(), &actions, &attributes, argv.data(), environ);
    const bool started = errno == 0;
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    close(in);
    close(out.write);
    close(err.write);
    out_ = out.read;
    err_ = err.read;
    require(started, program.c_str());
}

Process::~Process() {
    if (process_ > 0) {
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }
    if (out_ >= 0) close(out_);
    if (err_ >= 0) close(err_);
}

void Process::send(int signal) const { require(kill(process_, signal) == 0, "kill"); }

bool Process::gather(std::chrono::milliseconds pause) {
    std::array<pollfd, 2> ends{pollfd{out_, POLLIN, 0}, pollfd{err_, POLLIN, 0}};
    poll(ends.data(), ends.size(), static_cast<int>(pause.count()));
    if (out_ >= 0 && ends[0].revents != 0) readSome(out_, outcome_.out);
    if (err_ >= 0 && ends[1].revents != 0) readSome(err_, outcome_.err);
    return out_ >= 0 || err_ >= 0;
}

bool Process::waitForError(const std::string& text, std::chrono::seconds limit) {
    const auto end = Clock::now() + limit;
    while (outcome_.err.find(text) == std::string::npos)
        if (!gather(std::chrono::milliseconds(50)) || Clock::now() > end) return false;
    return true;
}

const Outcome& Process::gatherFor(std::chrono::milliseconds time) {
    gather(time);
    return outcome_;
}

void Process::closeReaders() {
    for (int* end : {&out_, &err_})
        if (const int descriptor = std::exchange(*end, -1); descriptor >= 0) close(descriptor);
}

Outcome Process::wait(std::chrono::seconds limit) {
    const auto end = Clock::now() + limit;
    int status = 0;
    while (gather(std::chrono::milliseconds(50)) || waitpid(process_, &status, WNOHANG) == 0) {
        if (out_ < 0 && err_ < 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        if (Clock::now() > end) {
            kill(process_, SIGKILL);
            waitpid(process_, nullptr, 0);
            process_ = -1;
            return outcome_;
        }
    }
    process_ = -1;
    outcome_.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return outcome_;
}

std::string lumorphProgram() { return LUMORPH_BIN_DIR "/lumorph"; }

Outcome lumorph(const std::vector<std::string>& arguments, const std::string& input) {
    return Process(lumorphProgram(), arguments, input).wait();
}

} // namespace lumorph::test
