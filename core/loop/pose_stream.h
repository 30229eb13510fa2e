#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "core/base/clock.h"

namespace lumorph {

/// Position and orientation in the frame `world`, metres.
struct Pose {
    glm::dvec3 position{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    bool operator==(const Pose&) const = default;
};

/// `worldFromBody` of a pose.
[[nodiscard]] glm::dmat4 matrixOf(const Pose& pose);
/// `aFromC` of `aFromB` and `bFromC`.
[[nodiscard]] Pose operator*(const Pose& aFromB, const Pose& bFromC);
[[nodiscard]] glm::dvec3 operator*(const Pose& aFromB, const glm::dvec3& inB);
[[nodiscard]] Pose inverseOf(const Pose& pose);

/// What a tracker said about one body at one moment.
struct PoseSample {
    Microseconds time{0}; ///< when it was measured, by the loop's clock
    bool valid = true;    ///< false: the tracker has lost it
    Pose pose;
};

/// The newest poses of one tracked body; a tracker pushes from its thread, the loop asks from its own. Poses between
/// and after samples come from a filter that is still when the body is: less than 0.3 mm of jitter at rest, and little
/// lag in motion.
class PoseStream {
public:
    /// Seconds after a measurement; what is extrapolated farther would only swing.
    static constexpr double kFarthestAhead = 0.15;

    /// Nothing newer than this makes it stale: as if lost.
    explicit PoseStream(Microseconds staleAfter = Microseconds{250'000});

    /// Samples that are not finite, or older than the newest, are left out; false then.
    bool push(const PoseSample& sample);
    /// Begins anew with a sample of another source: nothing before counts, and its times may be older. One that is not
    /// finite changes nothing; false then.
    bool restart(const PoseSample& sample);
    /// The newest valid sample is too old, or there was none. A body that was lost just now is not stale yet.
    [[nodiscard]] bool isStale(Microseconds now) const;
    [[nodiscard]] std::optional<PoseSample> latest() const;
    /// Where it will be at `time`, extrapolated from what was measured (`kFarthestAhead` at most); empty while
    /// lost or stale.
    [[nodiscard]] std::optional<Pose> at(Microseconds time, Microseconds now) const;

private:
    /// Called with the mutex held.
    void take(const PoseSample& sample);

    mutable std::mutex mutex_;
    Microseconds staleAfter_;
    struct Filter;
    std::shared_ptr<Filter> filter_;
};

/// What a tracked body stands for.
enum class PoseRole { head, device, pointer };

/// All streams of a show, by name; shared by trackers and loop.
class PoseBoard {
public:
    struct Entry {
        std::string name;
        PoseRole role = PoseRole::head;
        std::shared_ptr<PoseStream> stream;
    };
    /// The stream of that name; made when it is new.
    std::shared_ptr<PoseStream> stream(const std::string& name, PoseRole role);
    void remove(const std::string& name);
    [[nodiscard]] std::vector<Entry> entries() const;

private:
    mutable std::mutex mutex_;
    std::vector<Entry> entries_;
};

} // namespace lumorph
