#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace lumorph::test {

/// What a program left behind.
struct Outcome {
    int exitCode = -1; ///< 128 + the signal that ended it, or -1 when it had to be killed
    std::string out;
    std::string err;

    /// The one JSON value that `out` must be; anything else fails the test with an exception.
    [[nodiscard]] nlohmann::json json() const;
};

/// A program that runs; its output is gathered while it does. Killed, if it still runs, at the end.
class Process {
public:
    enum class ErrorStream { pipe, terminal };

    /// Starts `program`, found as a file. `input` is its standard input, whole.
    Process(const std::string& program, const std::vector<std::string>& arguments, const std::string& input = {},
            ErrorStream errors = ErrorStream::pipe);
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void send(int signal) const;
    /// Gathers output until stderr holds `text`; false when the program ends or time runs out before.
    bool waitForError(const std::string& text, std::chrono::seconds limit);
    /// Gathers output for so long, and gives what has come so far.
    const Outcome& gatherFor(std::chrono::milliseconds time);
    /// Nobody reads its output and its errors any more.
    void closeReaders();
    /// Gathers output until the program ends.
    Outcome wait(std::chrono::seconds limit = std::chrono::seconds(300));

private:
    bool gather(std::chrono::milliseconds pause);

    int process_ = -1;
    int out_ = -1;
    int err_ = -1;
    Outcome outcome_;
};

/// Runs the built `lumorph` to its end.
[[nodiscard]] Outcome lumorph(const std::vector<std::string>& arguments, const std::string& input = {});
[[nodiscard]] std::string lumorphProgram();

} // namespace lumorph::test
