#include "core/loop/viewer_stage.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

namespace lumorph {

namespace {

glm::mat4 matrixOf(const Pose& pose) {
    glm::dmat4 matrix = glm::mat4_cast(pose.rotation);
    matrix[3] = glm::dvec4(pose.position, 1.0);
    return {matrix};
}

/// Where drawing takes longer than the installation says, poses are predicted farther.
double lookAhead(const Installation& installation, double lightDelay) {
    return installation.predictionSeconds > 0.0 ? std::max(installation.predictionSeconds, lightDelay) : 0.0;
}

/// What the board's streams say about one moment to come.
class Outlook {
public:
    Outlook(const PoseBoard* board, double seconds, const glm::vec3& eyeFromHead, MatchFrame& frame)
        : eyeFromHead_(eyeFromHead), frame_(frame) {
        const Microseconds then = frame.time + Microseconds(std::llround(1e6 * seconds));
        if (board)
            for (const PoseBoard::Entry& entry : board->entries()) take(entry, then);
        if (!tracked) return;
        frame.ms.poseAge = 1e-3 * static_cast<double>(std::max(frame.time - oldest_, Microseconds{0}).count());
        frame.ms.latency = std::min(frame.ms.poseAge + 1e3 * seconds, 1e3 * PoseStream::kFarthestAhead);
    }

    std::vector<TrackedHead> heads;
    bool headsExpected = false; ///< a tracker follows heads, whether it sees one or not
    bool tracked = false;       ///< any body

private:
    void take(const PoseBoard::Entry& entry, Microseconds then) {
        headsExpected |= entry.role == PoseRole::head;
        const std::optional<Pose> pose = entry.stream->at(then, frame_.time);
        if (!pose || entry.role == PoseRole::pointer) return;
        tracked = true;
        if (const std::optional<PoseSample> sample = entry.stream->latest()) oldest_ = std::min(oldest_, sample->time);
        if (entry.role == PoseRole::head) heads.push_back({entry.name, pose->position + pose->rotation * eyeFromHead_});
        if (entry.role == PoseRole::device) frame_.worldFromDevice = matrixOf(*pose);
    }

    glm::dvec3 eyeFromHead_; ///< in the frame of a head's body
    MatchFrame& frame_;
    Microseconds oldest_ = Microseconds::max();
};

} // namespace

void ViewerStage::look(const MatchWish& wish, double sinceLast, MatchFrame& frame) {
    const Installation& installation = *wish.installation;
    frame.worldFromDevice = installation.worldFromDevice;
    const Outlook outlook(wish.poses.get(), lookAhead(installation, wish.lightDelay), installation.eyeFromHead, frame);
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
    moves_ = outlook.tracked;
}

bool anyTracked(const PoseBoard& board, Microseconds now) {
    return std::ranges::any_of(board.entries(), [&](const PoseBoard::Entry& entry) {
        return entry.role != PoseRole::pointer && entry.stream->at(now, now).has_value();
    });
}

} // namespace lumorph
