#pragma once

#include <array>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/table/table_truth.h"
#include "core/base/clock.h"
#include "core/loop/pose_stream.h"

namespace lumorph::table {

/// Bodies that the tracker sees.
enum class TableBody { device, pointer, head };
inline constexpr std::array<const char*, 3> kTableBodies = {"device", "pointer", "head"};

/// What stands on the table at a moment, world metres.
struct Standing {
    Pose device; ///< the world from the device
    std::vector<double> strokes;
    std::optional<glm::dmat4> worldFromBoard;
    std::optional<glm::dvec3> hand;
    bool isCovered = false; ///< the projectors' lenses
    bool operator==(const Standing&) const = default;
};

/// The table and all that hands move there. Any thread.
class Table {
public:
    explicit Table(TableTruth truth);

    [[nodiscard]] const TableTruth& truth() const noexcept { return truth_; }

    /// What stands there now, or stood a moment ago.
    [[nodiscard]] Standing at(Microseconds time) const;
    /// A body as it truly is in the room; empty for one that nobody has brought.
    [[nodiscard]] std::optional<Pose> body(TableBody body, Microseconds time) const;

    /// The device is carried to a place, with so many radians about the vertical, in so many seconds.
    void carry(const glm::dvec3& place, double turn, double seconds);
    /// The pointer's tip goes to a place and rests there, the pointer turned in a way that `turn` numbers.
    void touch(const glm::dvec3& place, int turn);
    /// The tip stays, and the pointer swings about it until it is told something else.
    void swing(const glm::dvec3& place);
    /// The head goes to where its eye is at a place, turned in a way that `turn` numbers.
    void look(const glm::dvec3& eye, int turn);
    void layBoard(const std::optional<glm::dmat4>& worldFromBoard);
    void holdHand(const std::optional<glm::dvec3>& place);
    void cover(bool covered);
    /// Where the parts of the device really are.
    void setStrokes(std::vector<double> strokes);

private:
    /// A body's way from one place to the next.
    struct Way {
        Pose from, to;
        Microseconds begins{0};
        double seconds = 0.0;
        bool swings = false;
    };
    [[nodiscard]] Pose along(const Way& way, Microseconds time) const;
    void go(TableBody body, const Pose& to, double seconds, bool swings = false);

    TableTruth truth_;
    SteadyClock clock_;
    mutable std::mutex mutex_; ///< of what follows
    std::array<std::optional<Way>, kTableBodies.size()> ways_;
    Standing standing_;
};

} // namespace lumorph::table
