#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/clock.h"
#include "core/base/image.h"

namespace lumorph::table {

/// A screen of the X display: a monitor as RandR names it.
struct Screen {
    std::string name;
    glm::ivec2 place{0}, size{0}; ///< pixels of the display
};

/// Looks at screens as they are (MIT-SHM, with the mouse pointer): whatever is in front there is what a projector at
/// that screen would throw. A thread of its own looks again when the display says that something changed (DAMAGE), at
/// most 100 times a second, and remembers the last half second. A busy machine does not make it late: a change counts
/// from when the display was told of it, and who asks waits until all until then is known.
class ScreenEye {
public:
    /// All screens of the display of the environment, the primary one first, then from left to right. Throws
    /// DeviceError where there is no display, or one that cannot be looked at.
    [[nodiscard]] static std::vector<Screen> screens();

    explicit ScreenEye(std::vector<Screen> screens);
    ~ScreenEye();
    ScreenEye(const ScreenEye&) = delete;
    ScreenEye& operator=(const ScreenEye&) = delete;

    /// What a screen showed, and since when.
    struct Shown {
        std::shared_ptr<const Image> picture;
        Microseconds since{0};
    };
    /// Of the last half second; an earlier time gives the oldest that is known. Any thread.
    [[nodiscard]] Shown at(std::size_t screen, Microseconds time) const;
    [[nodiscard]] const std::vector<Screen>& watched() const noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::table
