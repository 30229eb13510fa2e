#include "calibration/capture/boards_at_table.h"

#include <cmath>
#include <optional>
#include <utility>

#include "calibration/capture/pose_capture.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kAtRest =
    0.5; // pixels between two pictures: below it the board is at rest; held by hand it moves more
constexpr double kElsewhere = 0.03; // of the picture's width: another place
constexpr int kMostRefusals = 3;

/// Mean distance of the board's points in two pictures, pixels; a board that may be found turned is compared both ways.
double wayBetween(const BoardPoints& one, const BoardPoints& other) {
    if (one.seen.size() != other.seen.size()) return HUGE_VAL;
    double straight = 0.0, turned = 0.0;
    for (std::size_t i = 0; i < one.seen.size(); ++i) {
        straight += cv::norm(one.seen[i] - other.seen[i]);
        turned += cv::norm(one.seen[i] - other.seen[one.seen.size() - 1 - i]);
    }
    return std::min(straight, turned) / static_cast<double>(one.seen.size());
}

class BoardsCapturer {
public:
    BoardsCapturer(const BoardsAtTable& table, const Progress& progress)
        : table_(table), board_(parseCalibrationBoard(table.board)), progress_(progress) {
        std::vector<NamedDevice> projectors;
        for (const BoardsAtTable::Projector& projector : table.projectors) {
            PoseCaptureSettings settings;
            settings.order = parsePattern(table.pattern, projector.display->size());
            settings.board = board_;
            settings.clock = table.clock;
            orders_.push_back(settings.order);
            captures_.push_back(std::make_unique<PoseCapture>(*table.camera, *projector.display, std::move(settings)));
            projectors.push_back({projector.name, projector.display->size()});
        }
        std::vector<std::string> names;
        for (int pose = 1; pose <= table.poses; ++pose) names.push_back("pose_" + std::to_string(pose));
        capture_ = emptyBoardsCapture(table.board, {{table.cameraName, {}}}, std::move(projectors), names);
    }

    BoardsCapture run() {
        int refusals = 0;
        for (std::size_t pose = 0; pose < capture_.views.size();) {
            places_.push_back(waitForBoard(pose));
            const BoardsCapture before = capture_;
            try {
                takePose(pose);
                ++pose;
                refusals = 0;
            } catch (const CaptureRefused&) {
                if (++refusals == kMostRefusals) throw;
                capture_ = before;
            }
        }
        showAll(0);
        for (const BoardsAtTable::Projector& projector : table_.projectors) projector.display->clear();
        return std::move(capture_);
    }

private:
    [[nodiscard]] double fractionOf(std::size_t pose) const {
        return static_cast<double>(pose) / static_cast<double>(capture_.views.size());
    }

    void showAll(int grey) {
        for (const BoardsAtTable::Projector& projector : table_.projectors)
            projector.display->show(cv::Mat(projector.display->size(), CV_8U, cv::Scalar(grey)), progress_);
    }

    /// The board in a new place, once it rests there.
    BoardPoints waitForBoard(std::size_t pose) {
        const std::string number = std::to_string(pose + 1) + " of " + std::to_string(capture_.views.size());
        progress_.report(fractionOf(pose), pose == 0 ? "lay the board flat on the table, in the light of all projectors"
                                                     : "place " + number + ": tilt the board to another side");
        showAll(255);
        std::optional<BoardPoints> last;
        while (true) {
            progress_.throwIfCancelled();
            const cv::Mat picture = greyOf(table_.camera->grab(progress_));
            std::optional<BoardPoints> found = findBoard(picture, board_);
            bool isNew = found.has_value();
            for (const BoardPoints& place : places_)
                isNew = isNew && wayBetween(*found, place) > kElsewhere * picture.cols;
            if (isNew && last && wayBetween(*found, *last) < kAtRest) return *found;
            last = isNew ? std::move(found) : std::nullopt;
        }
    }

    void takePose(std::size_t pose) {
        const double each = 1.0 / static_cast<double>(captures_.size());
        for (std::size_t p = 0; p < captures_.size(); ++p) {
            for (std::size_t other = 0; other < captures_.size(); ++other)
                if (other != p)
                    table_.projectors[other].display->show(
                        cv::Mat::zeros(table_.projectors[other].display->size(), CV_8U), progress_);
            const double from = fractionOf(pose), whole = 1.0 / static_cast<double>(capture_.views.size());
            const Progress part = progress_.part(from + whole * each * static_cast<double>(p),
                                                 from + whole * each * static_cast<double>(p + 1));
            part.report(0.0, "do not touch anything: " + table_.projectors[p].name + " shows patterns");
            const std::string& name = capture_.views[pose].name;
            const CapturedPose taken = captures_[p]->capture(name, part);
            if (!taken.isSound()) throw CaptureRefused(*taken.findings.refusal);
            CapturedView view{name, {}};
            view.files.assign(taken.files.begin(), taken.files.end());
            const ReadPose read = readPose(view, taken.images, board_, orders_[p]);
            takeLight(capture_, pose, 0, p, read.observations, read.decoded.white.size());
            capture_.warnings.insert(capture_.warnings.end(), read.warnings.begin(), read.warnings.end());
        }
    }

    const BoardsAtTable& table_;
    CalibrationBoard board_;
    const Progress& progress_;
    std::vector<CaptureOrder> orders_;
    std::vector<std::unique_ptr<PoseCapture>> captures_;
    std::vector<BoardPoints> places_; ///< where it was photographed, or refused
    BoardsCapture capture_;
};

} // namespace

BoardsCapture captureBoards(const BoardsAtTable& table, const Progress& progress) {
    return BoardsCapturer(table, progress).run();
}

} // namespace lumorph
