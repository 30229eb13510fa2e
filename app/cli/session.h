#pragma once

#include <cstddef>
#include <filesystem>
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
    /// Takes over SIGINT and SIGTERM: the first asks the running work to stop, so that it can tidy up;
    /// a second ends the program at once.
    Session();
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Draws a bar on stderr while it is a terminal; nothing else where it is not.
    [[nodiscard]] Progress progress() const;
    /// Ends the line of a progress bar, if there is one.
    static void endProgress();

private:
    std::stop_source stop_;
    std::jthread watcher_;
};

/// Writes to a file, whole or not at all, or to stdout for "-".
void writeOutput(const std::string& path, std::span<const std::byte> bytes);
/// Reads a file, or stdin for "-".
[[nodiscard]] std::vector<std::byte> readInput(const std::string& path);
/// One JSON value on stdout.
void printJson(const nlohmann::json& value);

/// Parses "0,12,33". Throws InvalidInput naming the part that is no whole number.
[[nodiscard]] State parseState(const std::string& text);

[[nodiscard]] std::vector<std::byte> bytesOfText(const std::string& text);

} // namespace lumorph::cli
