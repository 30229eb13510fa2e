#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/progress.h"
#include "core/base/units.h"

namespace lumorph::cli {

/// What all commands share: where output goes, how progress is shown, and how Ctrl-C stops work.
class Session {
public:
    /// Takes over SIGINT, SIGTERM, SIGHUP and SIGQUIT: the first asks the running work to stop, so that it can tidy up;
    /// a second ends the program at once, but for `setLastAct`. A reader that goes away (SIGPIPE) ends nothing by
    /// itself: writing fails, and ReaderGone unwinds the command.
    Session();
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Draws a bar on stderr while it is a terminal; nothing where it is not.
    [[nodiscard]] Progress progress() const;
    /// Ends the line of a progress bar, if there is one.
    static void endProgress();
    /// Throws Cancelled once Ctrl-C was pressed; for between the stages of a command.
    void throwIfCancelled() const;

    /// Reads a file, or stdin for "-". Throws Cancelled when stopped while it waits.
    [[nodiscard]] std::vector<std::byte> readInput(const std::string& path) const;

    /// What must be done even before a second signal ends the program; empty: nothing. It runs in another thread,
    /// beside whatever the command does or waits for, and returns soon. When this returns, the one before runs no more.
    void setLastAct(std::function<void()> act);

    /// Gives the signals back to the system, for a program that takes the place of this one.
    static void releaseSignals() noexcept;
    /// Ends the program as the system ends one whose reader has gone.
    [[noreturn]] static void endByPipe() noexcept;

private:
    std::stop_source stop_;
    std::mutex lastActMutex_;
    std::function<void()> lastAct_;
    std::jthread watcher_;
};

/// Nobody reads what is printed any more: `| head -1`. It is no failure to tell; the command ends.
class ReaderGone : public std::exception {
public:
    [[nodiscard]] const char* what() const noexcept override { return "standard output: nobody reads it any more"; }
};
/// Throws ReaderGone where it is so.
void throwIfReaderGone();

/// What errors call a file: its path, or "standard input" for "-".
[[nodiscard]] std::string inputName(const std::string& path);

/// Refuses, before any work is done, an output that cannot become a file or that would replace `input`.
/// Throws DeviceError or InvalidInput.
void checkOutput(const std::string& path, const std::string& input);
/// Writes to a file, whole or not at all, or to stdout for "-".
void writeOutput(const std::string& path, std::span<const std::byte> bytes);
/// One JSON value on stdout. Text that is no UTF-8 gets replacement characters.
void printJson(const nlohmann::json& value);
/// Warnings on stderr, one a line.
void printWarnings(const std::vector<std::string>& warnings);
/// Throws DeviceError when what was printed could not be written, ReaderGone when nobody reads it.
void finishOutput();

/// Parses "0,12,33". Throws InvalidInput naming the part that is no whole number.
[[nodiscard]] State parseState(const std::string& text);

[[nodiscard]] std::vector<std::byte> bytesOfText(const std::string& text);

} // namespace lumorph::cli
