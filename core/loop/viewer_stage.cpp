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
    Outlook(const PoseBoard* board, double seconds, const Installation& installation, MatchFrame& frame)
        : installation_(installation), frame_(frame) {
        const Microseconds then = frame.time + Microseconds(std::llround(1e6 * seconds));
        if (board)
            for (const PoseBoard::Entry& entry : board->entries()) take(entry, then);
        if (!tracked) return;
        const double sinceSaid = 1e-3 * static_cast<double>(std::max(frame.time - oldest_, Microseconds{0}).count());
        frame.ms.poseAge = sinceSaid + 1e3 * installation.trackerSeconds;
        frame.ms.latency = std::min(sinceSaid + 1e3 * seconds, 1e3 * PoseStream::kFarthestAhead);
    }

    std::vector<TrackedHead> heads;
    bool headsExpected = false; ///< a tracker follows heads, whether it sees one or not
    bool tracked = false;       ///< any body

private:
    void take(const PoseBoard::Entry& entry, Microseconds then) {
        headsExpected |= entry.role == PoseRole::head;
        const std::optional<Pose> seen = entry.stream->at(then, frame_.time);
        if (!seen) return;
        if (entry.role == PoseRole::pointer) return addHand(*seen);
        tracked = true;
        const Pose pose = inRoom(installation_, entry.role, *seen);
        if (const std::optional<PoseSample> sample = entry.stream->latest()) oldest_ = std::min(oldest_, sample->time);
        if (entry.role == PoseRole::head)
            heads.push_back({entry.name, pose.position + pose.rotation * glm::dvec3(installation_.eyeFromHead)});
        if (entry.role == PoseRole::device) frame_.worldFromDevice = glm::mat4(matrixOf(pose));
    }

    void addHand(const Pose& seen) {
        const std::vector<Capsule> hand = handShape(installation_, seen);
        frame_.hands.insert(frame_.hands.end(), hand.begin(), hand.end());
    }

    const Installation& installation_;
    MatchFrame& frame_;
    Microseconds oldest_ = Microseconds::max();
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
    const Outlook outlook(wish.poses.get(), lookAhead(installation, wish.lightDelay), installation, frame);
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
    moves_ = outlook.tracked || !frame.hands.empty();
}

bool anyTracked(const PoseBoard& board, Microseconds now) {
    return std::ranges::any_of(board.entries(),
                               [&](const PoseBoard::Entry& entry) { return entry.stream->at(now, now).has_value(); });
}

} // namespace lumorph
