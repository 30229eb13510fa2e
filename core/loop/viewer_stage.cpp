#include "core/loop/viewer_stage.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "core/loop/hand_near.h"
#include "core/loop/tracked_room.h"

namespace lumorph {

namespace {

/// What the board's streams say about one moment to come.
class Outlook {
public:
    /// Writes where the device is into the frame, for its `lightTime`.
    Outlook(const PoseBoard* board, const Installation& installation, MatchFrame& frame)
        : installation_(installation), frame_(frame) {
        if (board)
            for (const PoseBoard::Entry& entry : board->entries()) take(entry, frame.lightTime);
    }

    /// Milliseconds from the oldest pose to the light.
    [[nodiscard]] double latency() const {
        if (!tracked) return 0.0;
        const double ahead = 1e-3 * static_cast<double>((frame_.lightTime - oldest).count());
        return std::clamp(ahead, 0.0, 1e3 * PoseStream::kFarthestAhead);
    }

    /// With their arms, which come from who looks.
    [[nodiscard]] std::vector<Capsule> hands(const std::optional<glm::vec3>& eye) const {
        std::vector<Capsule> all;
        for (const Pose& seen : hands_) {
            const std::vector<Capsule> hand = handShape(installation_, seen, eye);
            all.insert(all.end(), hand.begin(), hand.end());
        }
        return all;
    }

    std::vector<TrackedHead> heads;
    bool headsExpected = false; ///< a tracker follows heads, whether it sees one or not
    bool tracked = false;       ///< any body but hands
    Microseconds oldest = Microseconds::max();

private:
    void take(const PoseBoard::Entry& entry, Microseconds then) {
        headsExpected |= entry.role == PoseRole::head;
        const std::optional<Pose> seen = entry.stream->at(then, frame_.time);
        if (!seen) return;
        if (entry.role == PoseRole::pointer) return hands_.push_back(*seen);
        tracked = true;
        const Pose pose = inRoom(installation_, entry.role, *seen);
        if (const std::optional<PoseSample> sample = entry.stream->latest()) oldest = std::min(oldest, sample->time);
        if (entry.role == PoseRole::head)
            heads.push_back({entry.name, pose.position + pose.rotation * glm::dvec3(installation_.eyeFromHead)});
        if (entry.role == PoseRole::device) frame_.worldFromDevice = glm::mat4(matrixOf(pose));
    }

    const Installation& installation_;
    MatchFrame& frame_;
    std::vector<Pose> hands_;
};

} // namespace

double lightAhead(const Installation& installation, double lightDelay) {
    if (!(installation.predictionSeconds > 0.0)) return 0.0;
    return std::max(installation.predictionSeconds, lightDelay);
}

double lookAhead(const Installation& installation, double lightDelay) {
    if (!(installation.predictionSeconds > 0.0)) return 0.0;
    return lightAhead(installation, lightDelay) + installation.trackerSeconds;
}

void ViewerStage::look(const MatchWish& wish, double sinceLast, MatchFrame& frame) {
    const Installation& installation = *wish.installation;
    frame.worldFromDevice = installation.worldFromDevice;
    frame.poses = wish.poses;
    frame.lightTime = frame.time + Microseconds(std::llround(1e6 * lookAhead(installation, wish.lightDelay)));
    const Outlook outlook(wish.poses.get(), installation, frame);
    if (outlook.tracked) {
        const double sinceSaid =
            1e-3 * static_cast<double>(std::max(frame.time - outlook.oldest, Microseconds{0}).count());
        frame.ms.poseAge = sinceSaid + 1e3 * installation.trackerSeconds;
        frame.ms.latency = outlook.latency();
    }
    const glm::dvec3 centre(frame.worldFromDevice[3]);
    const std::optional<ViewerDirector::View> view =
        director_.step(outlook.heads, centre, installation.viewer, sinceLast);
    if (view) {
        frame.eye = glm::vec3(view->eye);
        frame.viewer = view->name;
        frame.handingOver = view->handingOver;
    } else if (!outlook.headsExpected && installation.viewer != ViewerChoice::none) {
        frame.eye = installation.eye;
    }
    frame.hands = outlook.hands(frame.eye);
    moves_ = outlook.tracked || !frame.hands.empty();
}

NewestView newestView(const MatchFrame& frame) {
    NewestView view{frame.worldFromDevice, frame.eye, frame.hands, frame.ms.latency};
    if (!frame.poses || !frame.installation) return view;
    MatchFrame late;
    late.time = frame.time;
    late.lightTime = frame.lightTime;
    late.worldFromDevice = frame.worldFromDevice;
    const Outlook outlook(frame.poses.get(), *frame.installation, late);
    view.worldFromDevice = late.worldFromDevice;
    view.latency = outlook.latency();
    const auto viewer = std::ranges::find(outlook.heads, frame.viewer, &TrackedHead::name);
    if (frame.eye && !frame.handingOver && !frame.viewer.empty() && viewer != outlook.heads.end())
        view.eye = glm::vec3(viewer->eye);
    view.hands = outlook.hands(view.eye);
    return view;
}

bool anyTracked(const PoseBoard& board, Microseconds now) {
    return std::ranges::any_of(board.entries(),
                               [&](const PoseBoard::Entry& entry) { return entry.stream->at(now, now).has_value(); });
}

} // namespace lumorph
