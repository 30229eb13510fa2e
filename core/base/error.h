#pragma once

#include <stdexcept>
#include <string>

namespace lumorph {

/// Common form of every error a user may see: what it is about (a file, an argument, a device),
/// why it failed, and what to do. `what()` reads "subject: why; remedy".
class Error : public std::runtime_error {
public:
    Error(std::string subject, std::string why, std::string remedy)
        : std::runtime_error(subject + ": " + why + "; " + remedy), subject_(std::move(subject)), why_(std::move(why)),
          remedy_(std::move(remedy)) {}

    [[nodiscard]] const std::string& subject() const noexcept { return subject_; }
    [[nodiscard]] const std::string& why() const noexcept { return why_; }
    [[nodiscard]] const std::string& remedy() const noexcept { return remedy_; }

private:
    std::string subject_;
    std::string why_;
    std::string remedy_;
};

/// The caller asked for something that cannot be: an argument out of range, shapes that do not agree.
class InvalidInput : public Error {
    using Error::Error;
};

/// A file or a packet is not what it claims to be.
class DataError : public Error {
    using Error::Error;
};

/// The world outside failed: a device, a disk, a graphics driver.
class DeviceError : public Error {
    using Error::Error;
};

/// Work was stopped at its user's wish; nothing was changed.
class Cancelled : public std::runtime_error {
public:
    Cancelled() : std::runtime_error("cancelled") {}
};

} // namespace lumorph
