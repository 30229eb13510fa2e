#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "app/applications/demo.h"
#include "core/base/clock.h"

namespace lumorph::studio {

/// Whose turn it is among the applications that answer visitors, in a circle. One that could not be shown is left out
/// until it may be another case: after a while, when it is told something else, or when a file that it is told of has
/// come, gone or changed.
class ApplicationTurn {
public:
    static constexpr Microseconds kLeftOut{600'000'000};
    using Told = std::function<DemoTold(const Demo&)>; ///< what an application would be told now

    /// `all` and `clock` outlive it.
    ApplicationTurn(std::span<const Demo> all, Told told, const Clock& clock);

    /// The one after that of a name, that one itself last; the first for any other name. Null: all are left out.
    [[nodiscard]] const Demo* after(const std::string& name) const;
    [[nodiscard]] bool leavesOut(const Demo& demo) const;
    /// It could not be shown.
    void failed(const Demo& demo);
    /// It is shown.
    void shown(const Demo& demo);

private:
    /// What may make a file another one. Of one that is not there all is 0.
    struct FileState {
        bool exists = false;
        std::filesystem::file_time_type written;
        std::uintmax_t size = 0; ///< of a file
        bool operator==(const FileState&) const = default;
    };
    struct Case {
        DemoTold told;
        std::vector<FileState> files;
        bool operator==(const Case&) const = default;
    };
    struct Failure {
        Case in;
        Microseconds until{0};
    };
    [[nodiscard]] static FileState stateOf(const std::filesystem::path& file);
    [[nodiscard]] Case caseOf(const Demo& demo) const;

    std::span<const Demo> all_;
    Told told_;
    const Clock& clock_;
    std::map<std::string, Failure> failures_; ///< by the names of applications
};

} // namespace lumorph::studio
