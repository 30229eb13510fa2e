#include "app/cli/session.h"

#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <iterator>
#include <memory>
#include <mutex>

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

} // namespace

Session::Session() {
    // The signals are blocked in every thread and waited for in one, which may do what a handler may not.
    const sigset_t signals = stopSignals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    watcher_ = std::jthread([this, signals](const std::stop_token& end) {
        const timespec pause{0, 200'000'000};
        while (!end.stop_requested()) {
            if (sigtimedwait(&signals, nullptr, &pause) < 0) continue;
            if (stop_.stop_requested()) _exit(1);
            stop_.request_stop();
        }
    });
}

Session::~Session() = default;

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

void writeOutput(const std::string& path, std::span<const std::byte> bytes) {
    if (path != "-") {
        writeFileAtomically(path, bytes);
        return;
    }
    std::fwrite(bytes.data(), 1, bytes.size(), stdout);
    if (std::fflush(stdout) != 0) throw DeviceError("standard output", "it cannot be written", "check where it goes");
}

std::vector<std::byte> readInput(const std::string& path) {
    if (path != "-") return readFile(path, kMaxInput);
    const std::string text{std::istreambuf_iterator<char>(std::cin), {}};
    return bytesOfText(text);
}

void printJson(const nlohmann::json& value) {
    std::cout << value.dump() << "\n" << std::flush;
    if (!std::cout) throw DeviceError("standard output", "it cannot be written", "check where it goes");
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
