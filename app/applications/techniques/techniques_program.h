#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "app/applications/techniques/techniques.h"
#include "app/applications/visitor.h"

namespace lumorph {

/// The techniques as visitors meet them. `key.0` to `key.6` choose one, as do left, right and next; `key.off` takes it
/// away and brings it back. So does who points to the left or to the right, leans the device there, or presses down
/// and up. Left to itself it shows one after the other, first without and then with.
class TechniquesProgram final : public ShowProgram {
public:
    static constexpr double kWithout = 3.0; ///< seconds of each, while it is left to itself
    static constexpr double kWith = 6.0;

    TechniquesProgram();

    [[nodiscard]] ShowContent frame(const ShowMoment& moment) override;

    [[nodiscard]] int key() const noexcept { return static_cast<int>(shown_); }
    [[nodiscard]] bool on() const noexcept { return on_; }

private:
    /// One of them, ready to be shown.
    struct Ready {
        std::array<std::shared_ptr<const Scene>, 2> scenes; ///< without, with
        std::array<std::shared_ptr<const ShowCaption>, 2> captions;
    };

    void playItself(double step);
    void answer(const ShowMoment& moment);
    void press(const ShowInput& input);
    void step(int by);
    void choose(std::size_t technique);

    std::vector<Ready> all_;
    std::shared_ptr<const SceneAssets> pictures_; ///< of all scenes
    Visitor visitor_;
    std::size_t shown_ = 1;
    bool on_ = false;
    double alone_ = 0.0;       ///< seconds of the present one that it was left to itself
    glm::dvec2 stick_{0.0};    ///< as it was told last
    std::optional<bool> side_; ///< to which side he points or leans; nothing in the middle
};

} // namespace lumorph
