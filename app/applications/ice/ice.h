#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/applications/demo.h"
#include "app/applications/ice/fish.h"
#include "app/applications/ice/ice_cover.h"
#include "app/applications/ice/pond.h"
#include "app/applications/ice/swell.h"
#include "app/applications/slosh.h"
#include "app/applications/visitor.h"
#include "core/loop/show_program.h"

namespace lumorph::ice {

/// A frozen pond as an application. Warmth (the pointer, a tracked hand, by itself the sun) melts holes, a rest of the
/// pointer and `key.next` crack the ice, the lean of the device and the bend of its servos break it; floes drift,
/// servos lift them, and what lies beneath is shown by light alone. `key.restart` freezes it over. Sounds are
/// `ice.crack`,
/// `.bump`, `.drip` and `.splash`.
class IceProgram final : public ShowProgram {
public:
    explicit IceProgram(std::uint64_t seed);

    [[nodiscard]] ShowContent frame(const ShowMoment& moment) override;

    [[nodiscard]] const IceCover& ice() const noexcept { return ice_; }
    [[nodiscard]] const School& school() const noexcept { return school_; }
    [[nodiscard]] const std::vector<Warmth>& warmths() const noexcept { return around_.warmths; }
    [[nodiscard]] const Meltwater& meltwater() const noexcept { return pond_.meltwater(); }
    [[nodiscard]] bool playsItself() const noexcept { return alone_; }

private:
    void takeDevice(const ShowMoment& moment);
    void takeHands(const ShowMoment& moment);
    void takePointer(double step);
    void play(double step);
    void turn();
    void freeze();
    [[nodiscard]] WaterLevel waterAt(const glm::dvec2& place) const noexcept;
    void noteOpenings(const std::vector<IceEvent>& events);

    Visitor visitor_;
    IceCover ice_;
    School school_;
    Pond pond_;
    Swell swell_;
    Slosh slosh_{0.10}; ///< little: the water stands 2.6 mm below the top of the ice
    std::shared_ptr<const Rig> rig_;
    std::optional<Bending> bending_;
    Surroundings around_;
    glm::dvec2 deviceLean_{0.0};       ///< of a tracked device, radians
    std::optional<glm::dvec2> rests_;  ///< where the pointer rests
    double resting_ = 0.0;             ///< seconds for which it has
    std::vector<glm::dvec2> openings_; ///< where holes came to be in this winter, the last few
    bool alone_ = true;
    double played_ = 0.0; ///< seconds of the show that it plays by itself
    double open_ = 0.0;   ///< seconds for which there has been hardly any ice
};

[[nodiscard]] Demo iceDemo();

} // namespace lumorph::ice
