#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <QString>
#include <glm/vec3.hpp>

#include "calibration/registration/pose_track.h"
#include "calibration/registration/touch_plan.h"

namespace lumorph::studio {

/// One thing that a person does while the tracker looks on.
struct LiveStep {
    enum class Ends {
        swung,        ///< after so many seconds of turning about the tip, which tell where it is
        atNewPlace,   ///< when the tip rests where it did not rest before
        heldOtherwise ///< when it rests, and the pointer is turned otherwise than at the step before
    };
    std::string name; ///< of what is touched: "dot 3"
    QString title;    ///< what is to be done: "Touch dot 3 of 16"
    Ends ends = Ends::atNewPlace;
    std::optional<PlannedDot> dot = std::nullopt;         ///< that the first projector shows meanwhile
    std::optional<PlannedLandmark> corner = std::nullopt; ///< of the device, which is drawn meanwhile
};

/// What a link asks of whom it measures with.
struct LivePlan {
    std::vector<PoseRole> roles; ///< bodies that must be seen all the time; the first is the pointer
    std::vector<LiveStep> steps;
};

/// What was recorded during one step, by bodies. At a rest it is the rest alone.
using LiveTake = std::map<PoseRole, PoseTrack>;

/// Follows a plan by the poses of tracked bodies as they arrive: sees by itself when a step is done, keeps what was
/// recorded then and goes to the next. A plain machine of poses and their times.
class LiveCapture {
public:
    static constexpr double kSwingSeconds = 12.0; ///< of turning
    static constexpr double kRestSeconds = 1.0;
    static constexpr double kRestRadius = 0.004; ///< metres, RMS, that a resting tip may stray

    /// `tip` in the pointer's frame, metres; a step with swings finds it anew.
    LiveCapture(LivePlan plan, const glm::dvec3& tip);

    /// A pose as the tracker gives it; an empty one says that the body is lost. Times of one clock; what goes back is
    /// left out.
    void add(PoseRole role, double seconds, const std::optional<Pose>& pose);
    /// The last step that was done is to be done again; at its begin, nothing.
    void takeBack();

    [[nodiscard]] const LivePlan& plan() const noexcept { return plan_; }
    [[nodiscard]] std::size_t step() const noexcept { return takes_.size(); } ///< that is done now
    [[nodiscard]] bool isComplete() const noexcept { return takes_.size() == plan_.steps.size(); }
    [[nodiscard]] const std::vector<LiveTake>& takes() const noexcept { return takes_; }
    [[nodiscard]] double fraction() const noexcept { return fraction_; } ///< of the step
    /// Why it does not go on, in a sentence; empty: it does.
    [[nodiscard]] const std::string& trouble() const noexcept { return trouble_; }
    /// Bodies that have not been seen for a moment, by the time of the newest pose of all.
    [[nodiscard]] std::vector<PoseRole> missing() const;

private:
    struct Rested {
        glm::dvec3 tip{0.0};
        glm::dquat turn{1.0, 0.0, 0.0, 0.0};
    };
    void followSwings();
    void followRest();
    void finishStep(LiveTake take);
    [[nodiscard]] std::optional<Rested> resting() const;
    [[nodiscard]] LiveTake lastMoments() const;

    LivePlan plan_;
    glm::dvec3 tip_;
    std::vector<LiveTake> takes_;
    std::vector<Rested> rested_;                       ///< one a take
    std::map<PoseRole, std::deque<TimedPose>> recent_; ///< of this step
    double newest_ = 0.0;
    double turned_ = 0.0; ///< seconds of swings
    double fraction_ = 0.0;
    std::string trouble_;
};

} // namespace lumorph::studio
