#include "app/cli/session.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <mutex>
#include <utility>

#include <poll.h>
#include <unistd.h>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file.h"

namespace lumorph::cli {

namespace {

constexpr std::size_t kMaxInput = std::size_t{2} << 30;

sigset_t stopSignals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGHUP);
    sigaddset(&signals, SIGQUIT);
    return signals;
}

void drawBar(double fraction, std::string_view stage) {
    constexpr int kWidth = 30;
    const int filled = static_cast<int>(fraction * kWidth);
    std::string bar(static_cast<std::size_t>(filled), '#');
    bar.resize(kWidth, '.');
    std::fprintf(stderr, "\r\033[K[%s] %3d %%  %.*s", bar.c_str(), static_cast<int>(100 * fraction),
                 static_cast<int>(stage.size()), stage.data());
    std::fflush(stderr);
}

std::vector<std::byte> readStandardInput(const Session& session) {
    constexpr int kPauseMilliseconds = 100;
    std::vector<std::byte> bytes;
    std::array<std::byte, 1U << 16U> chunk{};
    for (;;) {
        session.throwIfCancelled();
        pollfd input{STDIN_FILENO, POLLIN, 0};
        if (poll(&input, 1, kPauseMilliseconds) == 0) continue;
        const ssize_t got = read(STDIN_FILENO, chunk.data(), chunk.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw DeviceError("standard input", "it cannot be read", "check where it comes from");
        if (got == 0) return bytes;
        bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + got);
        if (bytes.size() > kMaxInput) throw DataError("standard input", "it is larger than 2 GiB", "give a file");
    }
}

[[noreturn]] void failOutput() {
    throwIfReaderGone();
    throw DeviceError("standard output", "it cannot be written", "check where it goes");
}

} // namespace

Session::Session() {
    // The signals are blocked in every thread and waited for in one, which may do what a handler may not.
    const sigset_t signals = stopSignals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    watcher_ = std::jthread([this, signals](const std::stop_token& end) {
        for (;;) {
            const int signal = sigwaitinfo(&signals, nullptr);
            if (end.stop_requested()) return;
            if (signal < 0) continue;
            if (stop_.stop_requested()) {
                const std::scoped_lock lock(lastActMutex_);
                if (lastAct_) lastAct_();
                _exit(1);
            }
            stop_.request_stop();
        }
    });
}

Session::~Session() {
    watcher_.request_stop();
    // The signal is blocked everywhere, so this only wakes the wait above.
    pthread_kill(watcher_.native_handle(), SIGINT); // NOLINT(bugprone-bad-signal-to-kill-thread)
}

void Session::setLastAct(std::function<void()> act) {
    const std::scoped_lock lock(lastActMutex_);
    lastAct_ = std::move(act);
}

void Session::endByPipe() noexcept {
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
    _exit(1); // where somebody has blocked it
}

void Session::releaseSignals() noexcept {
    std::signal(SIGPIPE, SIG_DFL);
    const sigset_t signals = stopSignals();
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

void Session::throwIfCancelled() const {
    if (stop_.stop_requested()) throw Cancelled();
}

Progress Session::progress() const {
    if (isatty(STDERR_FILENO) == 0) return Progress({}, stop_.get_token());
    auto mutex = std::make_shared<std::mutex>();
    auto last = std::make_shared<int>(-1);
    return Progress(
        [mutex, last](double fraction, std::string_view stage) {
            const std::lock_guard lock(*mutex);
            const int percent = static_cast<int>(100 * fraction);
            if (percent == *last) return;
            *last = percent;
            drawBar(fraction, stage);
        },
        stop_.get_token());
}

void Session::endProgress() {
    if (isatty(STDERR_FILENO) != 0) std::fputs("\r\033[K", stderr);
}

void throwIfReaderGone() {
    pollfd output{STDOUT_FILENO, 0, 0};
    if (poll(&output, 1, 0) > 0 && (output.revents & (POLLERR | POLLHUP)) != 0) throw ReaderGone();
}

std::string inputName(const std::string& path) { return path == "-" ? "standard input" : path; }

std::vector<std::byte> Session::readInput(const std::string& path) const {
    return path == "-" ? readStandardInput(*this) : readFile(path, kMaxInput);
}

void checkOutput(const std::string& path, const std::string& input) {
    namespace fs = std::filesystem;
    if (path == "-") return;
    std::error_code ignored;
    if (path.empty()) throw InvalidInput("--output", "it is empty", "name a file");
    if (fs::is_directory(path, ignored)) throw DeviceError(path, "it is a folder", "name a file in it");
    const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
    if (!fs::is_directory(folder, ignored))
        throw DeviceError(path, "there is no folder " + folder.string(), "make it first, or choose another place");
    if (fs::equivalent(path, input, ignored))
        throw InvalidInput(path, "it would replace what is read", "choose another name");
}

void writeOutput(const std::string& path, std::span<const std::byte> bytes) {
    if (path != "-") {
        writeFileAtomically(path, bytes);
        return;
    }
    std::fwrite(bytes.data(), 1, bytes.size(), stdout);
    finishOutput();
}

void printJson(const nlohmann::json& value) {
    std::cout << value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << "\n" << std::flush;
    if (!std::cout) failOutput();
}

void printWarnings(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) std::fprintf(stderr, "lumorph: warning: %s\n", warning.c_str());
}

void finishOutput() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) failOutput();
}

State parseState(const std::string& text) {
    State state;
    std::size_t begin = 0;
    while (begin <= text.size()) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string part = text.substr(begin, end - begin);
        int level = 0;
        const auto parsed = std::from_chars(part.data(), part.data() + part.size(), level);
        if (part.empty() || parsed.ec != std::errc() || parsed.ptr != part.data() + part.size())
            throw InvalidInput("--state", "'" + part + "' is not a whole number",
                               "give one level for each actuator, such as 0,12,33");
        state.push_back(Level{level});
        begin = end + 1;
    }
    return state;
}

std::vector<std::byte> bytesOfText(const std::string& text) {
    const auto bytes = std::as_bytes(std::span<const char>(text));
    return {bytes.begin(), bytes.end()};
}

} // namespace lumorph::cli
