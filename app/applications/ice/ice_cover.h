#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "app/applications/ice/bending.h"
#include "app/applications/ice/bob.h"
#include "app/applications/ice/cracks.h"
#include "app/applications/ice/floe_world.h"
#include "app/applications/ice/melting.h"
#include "app/applications/ice/sheet.h"

namespace lumorph::ice {

/// What hangs together of the sheet: all of it at first, and at last single cells.
struct Floe {
    std::vector<int> cells; ///< of the sheet, ascending
    bool fixed = true;      ///< frozen to the bank
    double area = 0.0;      ///< square metres
    glm::dvec2 centre{0.0}; ///< home coordinates
    double radius = 0.0;    ///< of a disc about the centre that holds it, metres
    FloeMotion motion;
    Bob bob;
    std::uint64_t version = 0; ///< of its shape
    std::uint64_t shaped = 0;  ///< version that its body has
    int body = -1;
    int number = 0; ///< of this floe alone, from 1
};

[[nodiscard]] glm::dvec2 centreNow(const Floe& floe) noexcept;

struct IceEvent {
    enum class Kind : std::uint8_t { crack, bump, drip, splash };
    Kind kind = Kind::crack;
    double strength = 1.0;
    glm::dvec2 place{0.0};
};

/// What a weight on the ice is: a finger, a hand.
struct Press {
    glm::dvec2 place{0.0};
    double volume = 0.0; ///< of water that weighs as much, cubic metres
};

/// What acts on the ice from outside.
struct Surroundings {
    std::vector<Warmth> warmths;
    std::vector<Press> presses;
    glm::dvec2 lean{0.0};             ///< of the device, radians, as Visitor::lean
    double thaw = 0.0;                ///< by which all free rims draw back, metres a second
    const Bending* bending = nullptr; ///< the device's surface; none: flat
    /// Where the servos hold the water up, at a place of the pond; none: nowhere.
    std::function<WaterLevel(const glm::dvec2&)> lift;
};

/// The ice of a pond from frost to thaw: it gets holes, cracks, breaks into floes, and freezes over again. The same
/// calls give the same ice, bit for bit.
class IceCover {
public:
    static constexpr double kFreezing = 3.6; ///< seconds until it is frozen over
    static constexpr double kLeaving = 1.2;  ///< seconds in which old ice goes before

    /// Begins with frost.
    IceCover(Polygon shore, std::uint64_t seed);

    void advance(double seconds, const Surroundings& around);
    /// Begins a star of cracks where ice lies, or a little beside; false where none does.
    bool strike(const glm::dvec2& place);
    /// Old ice goes, and frost closes the pond.
    void freeze();

    [[nodiscard]] const Polygon& shore() const noexcept { return shore_; }
    [[nodiscard]] const Sheet& sheet() const noexcept { return sheet_; }
    [[nodiscard]] const std::vector<Floe>& floes() const noexcept { return floes_; }
    /// What has happened since this was asked last.
    [[nodiscard]] std::vector<IceEvent> takeEvents() noexcept { return std::exchange(events_, {}); }
    [[nodiscard]] bool freezing() const noexcept { return frost_ < 1.0; }
    /// A cell as it is now in home coordinates: smaller than its outline while frost grows.
    [[nodiscard]] Polygon grown(int cell) const;
    [[nodiscard]] double growth(int cell) const noexcept; ///< 0 to 1, of its width
    /// Square metres that are ice, and that are not: together the pond.
    [[nodiscard]] double iceArea() const noexcept;
    [[nodiscard]] double melted() const noexcept;
    [[nodiscard]] std::uint64_t winter() const noexcept { return winter_; } ///< how often it froze over, from 1

private:
    void beginWinter();
    void step(const Surroundings& around);
    void meltAll(const Surroundings& around, double seconds);
    void strain(const Surroundings& around, double seconds);
    [[nodiscard]] double stressOn(const Bond& bond, const Surroundings& around) const;
    [[nodiscard]] const Floe& floeOf(const Bond& bond) const;
    void gather();
    void inherit(Floe& floe, Floe* from);
    void loosen();
    void reshape();
    void measure(Floe& floe) const;
    void move(const Surroundings& around);
    void readBumps();
    [[nodiscard]] std::vector<Polygon> piecesOf(const Floe& floe) const;
    struct Target {
        int floe = -1;
        glm::dvec2 home{0.0};
    };
    [[nodiscard]] Target nearestIce(const glm::dvec2& place) const;
    void startStar(const glm::dvec2& home);
    void happened(IceEvent::Kind kind, double strength, const glm::dvec2& place);

    Polygon shore_;
    std::uint64_t seed_;
    std::uint64_t winter_ = 0;
    std::mt19937_64 random_;
    Sheet sheet_;
    Cracks cracks_;
    FloeWorld world_;
    std::vector<Floe> floes_;
    std::vector<IceEvent> events_;
    std::vector<double> frostBegins_; ///< of each cell, as a share of all frost
    double frost_ = 0.0;
    double leaving_ = 0.0; ///< seconds for which old ice still goes
    double left_ = 0.0;    ///< seconds that no step has taken yet
    double thawing_ = 0.0; ///< metres by which free rims are still to draw back
    double calm_ = 0.0;    ///< seconds until stress may crack it again
    std::uint64_t steps_ = 0;
    int numbers_ = 0;
};

} // namespace lumorph::ice
