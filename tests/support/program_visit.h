#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "core/base/resources.h"
#include "core/loop/show_program.h"
#include "core/rig/rig_file.h"

/// An application asked frame by frame, as the loop asks it.
namespace lumorph::test {

constexpr double kFrame = 1.0 / 60.0;

inline const std::shared_ptr<const Rig>& tabletRig() {
    static const auto rig = std::make_shared<const Rig>(readRig(resourceFile("models/tablet.glb")));
    return rig;
}

class ProgramVisit {
public:
    /// A frame every `step` seconds: long ones where only what comes in the end counts.
    explicit ProgramVisit(ShowProgram& program, double step = kFrame) : program_(program), step_(step) {
        moment_.rig = tabletRig();
        moment_.installation = std::make_shared<const Installation>(defaultInstallation());
    }

    const ShowContent& frame(std::vector<ShowInput> inputs = {}) {
        moment_.inputs = inputs;
        moment_.bodies = bodies_;
        content_ = program_.frame(moment_);
        moment_.inputs = {};
        moment_.step = step_;
        moment_.seconds += step_;
        for (const ShowSound& sound : content_.sounds) ++heard_[sound.name];
        return content_;
    }
    void frames(double seconds) {
        for (int k = 0; k < std::lround(seconds / step_); ++k) frame();
    }
    /// The tracked device leans so far about the world's axes, radians.
    void lean(float aboutX, float aboutZ) {
        bodies_ = {ShowBody{"Tablet", PoseRole::device, {}}};
        moment_.worldFromDevice = glm::mat4_cast(glm::angleAxis(aboutX, glm::vec3(1.0F, 0.0F, 0.0F)) *
                                                 glm::angleAxis(aboutZ, glm::vec3(0.0F, 0.0F, 1.0F)));
    }
    /// These bodies are tracked from now on.
    void see(std::vector<ShowBody> bodies) { bodies_ = std::move(bodies); }
    [[nodiscard]] const SceneItem& item(int id) const { return *findItem(*content_.scene, id); }
    [[nodiscard]] int heard(const std::string& sound) const {
        const auto found = heard_.find(sound);
        return found == heard_.end() ? 0 : found->second;
    }
    [[nodiscard]] const ShowContent& content() const { return content_; }

private:
    ShowProgram& program_;
    double step_;
    ShowMoment moment_;
    std::vector<ShowBody> bodies_;
    ShowContent content_;
    std::map<std::string, int> heard_;
};

} // namespace lumorph::test
