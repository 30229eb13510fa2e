#include <algorithm>

#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QVBoxLayout>
#include <opencv2/imgproc.hpp>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/segments.h"
#include "app/workspaces/calibrate/calibrate_commands.h"
#include "app/workspaces/calibrate/calibrate_docks.h"
#include "app/workspaces/calibrate/capture_picture.h"
#include "app/workspaces/calibrate/error_map_view.h"
#include "app/workspaces/common/step_card.h"

namespace lumorph::studio {
namespace {

using Show = CalibrateSelection::Show;

constexpr double kArrowShare = 0.06;     // of the picture's width, for the longest arrow
constexpr double kClippedToTell = 0.001; // of the pixels

StepCardText cardOf(const NextStep& next) {
    return {next.tone, next.title, next.text, next.button, next.what == NextStep::Do::stop};
}

/// Around all points of a board.
QPolygonF hullOf(const ViewObservations& seen) {
    std::vector<cv::Point2f> points(seen.corners.seen.begin(), seen.corners.seen.end()), hull;
    if (points.size() < 3) return {};
    cv::convexHull(points, hull);
    QPolygonF outline;
    for (const cv::Point2f& point : hull) outline << QPointF(point.x, point.y);
    return outline;
}

class CalibrateView : public QWidget {
public:
    explicit CalibrateView(const CalibrateParts& parts)
        : parts_(parts), card_(new StepCard("calibrate.card", "target", this)), picture_(new CapturePicture(this)) {
        setObjectName("calibrate.view");
        setProperty("look", "panel");
        setAttribute(Qt::WA_StyledBackground);
        auto* column = new QVBoxLayout(this);
        column->setContentsMargins(16, 8, 16, 8);
        column->setSpacing(8);
        column->addWidget(card_);
        column->addWidget(makeNoticeBar(parts.studio.notices, "calibrate"));
        progress_ = new QProgressBar(this);
        progress_->setObjectName("calibrate.progress");
        progress_->setRange(0, 1000);
        progress_->setTextVisible(false);
        QSizePolicy keeps = progress_->sizePolicy();
        keeps.setRetainSizeWhenHidden(true); // so that nothing jumps when work begins
        progress_->setSizePolicy(keeps);
        column->addWidget(progress_);
        column->addWidget(makeBar());
        column->addWidget(picture_, 1);
        map_ = new ErrorMapView(this);
        column->addWidget(map_, 1);
        legend_ = new QLabel(this);
        legend_->setObjectName("calibrate.legend");
        legend_->setProperty("look", "muted");
        legend_->setWordWrap(true);
        column->addWidget(legend_);
        connect(card_, &StepCard::nextWanted, parts.studio.commands.find("calibrate.next"), &QAction::trigger);
        connect(&parts.service, &CalibrationService::changed, this, [this] { refresh(); });
        connect(&parts.service, &CalibrationService::liveChanged, this, [this] { showPicture(); });
        connect(&parts.selection, &CalibrateSelection::changed, this, [this] { showPicture(); });
        refresh();
    }

private:
    QWidget* makeBar() {
        auto* bar = new QWidget(this);
        auto* rows = new QVBoxLayout(bar); // side by side they are cut in a narrow window
        rows->setContentsMargins(0, 0, 0, 0);
        rows->setSpacing(8);
        segments_ = new Segments(
            {{"calibrate.show.live", "Live", "What the camera sees now"},
             {"calibrate.show.white", "Picture", "The chosen pose under white light, with the board's points"},
             {"calibrate.show.columns", "Columns", "Which column of the projector lights each pixel, in colours"},
             {"calibrate.show.rows", "Rows", "Which row of the projector lights each pixel, in colours"},
             {"calibrate.show.confidence", "Confidence", "Bright where the patterns could be read well"},
             {"calibrate.show.errors", "Errors", "Where points lie beside what was solved, enlarged"},
             {"calibrate.show.map", "Map", "How far light may land beside, on table and device"}},
            bar);
        connect(segments_, &Segments::chosen, this, [this](int index) {
            if (static_cast<Show>(index) != Show::live && static_cast<Show>(index) != Show::map &&
                parts_.selection.pose().empty() && !parts_.service.state().poses.empty())
                parts_.selection.set(static_cast<Show>(index), parts_.service.state().poses.back().name);
            else
                parts_.selection.setShow(static_cast<Show>(index));
        });
        poseName_ = new QLabel(bar);
        poseName_->setObjectName("calibrate.poseName");
        poseName_->setProperty("look", "heading");
        rows->addWidget(segments_, 0, Qt::AlignLeft);
        auto* row = new QHBoxLayout;
        rows->addLayout(row);
        row->addWidget(poseName_);
        row->addStretch(1);
        rest_ = makeCommandButton(parts_.studio.commands.find("calibrate.rest"), "calibrate.rest", bar);
        row->addWidget(rest_);
        another_ = makeCommandButton(parts_.studio.commands.find("calibrate.another"), "calibrate.another", bar);
        row->addWidget(another_);
        return bar;
    }

    void refresh() {
        const CalibrationState& state = parts_.service.state();
        StepCardText card = cardOf(nextOf(state));
        card.button = buttonOf(state);
        card_->show(card);
        progress_->setVisible(state.work != CalibrationState::Work::none);
        progress_->setValue(static_cast<int>(1000.0 * state.fraction));
        rest_->setVisible(state.setup.way == CaptureWay::lab && state.counting() < state.setup.poses &&
                          state.work == CalibrationState::Work::none && !state.result);
        another_->setVisible(offersAnother(state));
        // A pose that has just come in, or the one that was refused, is what one wants to see.
        if (const auto* wanted = newlySeen(state)) parts_.selection.set(Show::white, wanted->name);
        count_ = state.poses.size();
        const bool live = isLive(state.setup.way);
        if (!live && parts_.selection.show() == Show::live && !state.poses.empty())
            parts_.selection.set(Show::white, state.poses.front().name);
        const Show show = parts_.selection.show();
        if (live && state.poses.empty() && show != Show::live && show != Show::map)
            parts_.selection.set(Show::live, {});
        if (live && state.work == CalibrationState::Work::capturing) parts_.selection.setShow(Show::live);
        showPicture();
    }

    const CalibrationPose* newlySeen(const CalibrationState& state) {
        const bool isFolder = state.setup.way == CaptureWay::folder;
        for (const CalibrationPose& pose : state.poses)
            if (pose.refusal && !pose.leftOut && refused_ != pose.name) {
                refused_ = pose.name;
                return &pose;
            }
        if (std::ranges::none_of(state.poses, [](const CalibrationPose& pose) { return pose.refusal.has_value(); }))
            refused_.clear();
        return isFolder && state.poses.size() > count_ ? &state.poses.back() : nullptr;
    }

    [[nodiscard]] const CalibrationPose* chosen() const {
        const auto& poses = parts_.service.state().poses;
        const auto found = std::ranges::find(poses, parts_.selection.pose(), &CalibrationPose::name);
        return found == poses.end() ? nullptr : &*found;
    }

    void showPicture() {
        const Show show = parts_.selection.show();
        segments_->setChosen(static_cast<int>(show));
        map_->setVisible(show == Show::map);
        picture_->setVisible(show != Show::map);
        if (show == Show::map) {
            const auto& result = parts_.service.state().result;
            poseName_->clear();
            legend_->clear();
            map_->show(result ? result->plan : std::nullopt, deviceOutlineOf(parts_.studio.document.state()));
            return;
        }
        if (show == Show::live) return showLive();
        const CalibrationPose* pose = chosen();
        poseName_->setText(pose ? QString::fromStdString(pose->name) : QString());
        if (!pose || !pose->pictures) {
            legend_->clear();
            picture_->show({}, {}, {},
                           pose ? "This pose has no picture" : "No pose yet. What was photographed is seen here.");
            return;
        }
        const PosePictures& pictures = *pose->pictures;
        PictureMarks marks;
        QImage image = pictures.white;
        switch (show) {
        case Show::columns:
            image = pictures.columns;
            legend_->setText("Colours run from the projector's left to its right edge; a darker line every 64 columns. "
                             "Dark: nothing could be read there.");
            break;
        case Show::rows:
            image = pictures.rows;
            legend_->setText("Colours run from the projector's upper to its lower edge; a darker line every 64 rows. "
                             "Dark: nothing could be read there.");
            break;
        case Show::confidence:
            image = pictures.confidence;
            legend_->setText("Bright: pattern and inverse differ clearly. Black: no projector light, shadow, or too "
                             "little contrast.");
            break;
        case Show::errors:
            addArrows(marks, pose->name);
            break;
        default:
            legend_->setText(pose->seen ? "Rings: points of the board that were found; the filled one is the first."
                                        : "The image in which it was noticed.");
        }
        if (image.isNull()) image = pictures.white;
        if (show != Show::errors && pose->seen)
            for (const cv::Point2d& point : pose->seen->corners.seen) marks.corners.emplace_back(point.x, point.y);
        if (pose->refusal) marks.words = wordsOf(*pose->refusal).title;
        picture_->show(image, pictures.camera, std::move(marks), {});
    }

    void addArrows(PictureMarks& marks, const std::string& pose) {
        const auto& result = parts_.service.state().result;
        legend_->setText("There is nothing solved yet.");
        if (!result) return;
        const auto found = std::ranges::find(result->residuals, pose, &PoseResiduals::name);
        if (found == result->residuals.end()) return;
        double longest = 0.0;
        for (const Residual& one : found->camera) longest = std::max(longest, cv::norm(one.error));
        if (!(longest > 0.0)) return legend_->setText("The errors of this pose are not known.");
        for (const Residual& one : found->camera)
            marks.arrows.push_back({{one.at.x, one.at.y}, {one.error.x, one.error.y}});
        marks.arrowScale = kArrowShare * result->solved.camera.size.width / longest;
        legend_->setText(QString("Arrows go from where a point was seen to where the solution has it, %1 times as "
                                 "long; the longest is %2 pixels.")
                             .arg(marks.arrowScale, 0, 'f', 0)
                             .arg(longest, 0, 'f', 2));
    }

    void showLive() {
        const CalibrationState& state = parts_.service.state();
        const LiveSight& live = parts_.service.live();
        poseName_->clear();
        PictureMarks marks;
        marks.corners = live.corners;
        for (const CalibrationPose& pose : state.poses)
            if (pose.counts()) marks.coverage.push_back(hullOf(*pose.seen));
        const bool wantsMore = state.counting() < state.setup.poses && state.work == CalibrationState::Work::none;
        if (wantsMore || offersAnother(state)) {
            for (const QPointF& point : live.ghost) marks.ghost << point;
            marks.ghostText = QString("Pose %1").arg(freeNumber(state) + 1);
        }
        marks.words = live.words;
        if (!live.picture.isNull() && live.sharpest > 0.0) {
            marks.histogram.assign(live.light.histogram.begin(), live.light.histogram.end());
            marks.light =
                QString("Sharpness %1, best %2").arg(live.light.sharpness, 0, 'f', 1).arg(live.sharpest, 0, 'f', 1);
            if (live.light.clipped >= kClippedToTell)
                marks.light += QString("; %1 % clipped").arg(100.0 * live.light.clipped, 0, 'f', 1);
        }
        legend_->setText(live.picture.isNull() ? QString()
                                               : "Dashed: where the board should be next. Green: where boards have "
                                                 "been; together they should fill the picture. Red: whiter than the "
                                                 "camera can tell; expose for less.");
        const QString empty = state.setup.way == CaptureWay::folder ? "A folder has no live picture."
                              : live.words.isEmpty()                ? "No camera yet"
                                                                    : live.words;
        picture_->show(live.picture, live.camera, std::move(marks), empty);
    }

    CalibrateParts parts_;
    StepCard* card_;
    CapturePicture* picture_;
    ErrorMapView* map_ = nullptr;
    QProgressBar* progress_ = nullptr;
    Segments* segments_ = nullptr;
    QLabel* poseName_ = nullptr;
    QPushButton* rest_ = nullptr;
    QPushButton* another_ = nullptr;
    QLabel* legend_ = nullptr;
    std::size_t count_ = 0;
    std::string refused_;
};

} // namespace

QWidget* makeCalibrateView(const CalibrateParts& parts) { return new CalibrateView(parts); }

} // namespace lumorph::studio
