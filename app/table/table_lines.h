#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/table/gige_camera.h"
#include "app/table/screen_eye.h"
#include "app/table/servo_port.h"
#include "app/table/table.h"
#include "app/table/tracker_server.h"

namespace lumorph::table {

/// All that stands behind the table's sockets. It outlives the lines.
struct TableParts {
    Table& table;
    const ScreenEye& eye;
    TrackerServer& tracker;
    ServoPort& servos;
    std::vector<std::unique_ptr<GigeCamera>>& cameras;
};

/// The hands: does what a line of text says. One thread at a time.
class TableLines {
public:
    explicit TableLines(TableParts parts);

    /// One line of JSON: {"ok":true, ...}, or {"ok":false, "error": what is wrong and what is possible}. A line that is
    /// refused changes nothing.
    [[nodiscard]] std::string answer(std::string_view line);
    [[nodiscard]] bool ended() const noexcept { return ended_; }

    /// What lines can be, for help.
    [[nodiscard]] static std::string_view help();

private:
    struct Words;
    void board(const Words& words);
    void touch(const Words& words);
    void look(const Words& words);
    void fault(const Words& words);
    /// How late pixels follow poses, milliseconds: of jumps of the device, from the tracker's packet to another picture
    /// on the first projector's screen. Light comes `light_ms` after that. Throws InvalidInput where the screen does
    /// not come to rest, or does not follow.
    [[nodiscard]] std::string latency(const Words& words);
    /// Where the middle of a projector's small spot of light falls on the table: a dot, with or without a ring. Throws
    /// InvalidInput where none shows one.
    [[nodiscard]] glm::dvec3 dot() const;
    [[nodiscard]] glm::dvec3 placeOf(const Words& words, std::size_t first) const;

    TableParts parts_;
    std::vector<glm::dmat4> boardPoses_; ///< worked out when they are first asked for
    int turns_ = 0;                      ///< of the wrist, so that no two touches are alike
    bool ended_ = false;
};

} // namespace lumorph::table
