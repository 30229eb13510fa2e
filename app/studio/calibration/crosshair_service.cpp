#include "app/studio/calibration/crosshair_service.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QPainter>
#include <QPolygonF>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "app/studio/base/notices.h"
#include "app/studio/calibration/capture_bench.h"
#include "calibration/lab/true_room.h"
#include "calibration/report/calibrated_room.h"
#include "calibration/solve/crosshair_points.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr int kMostPoints = 8;
constexpr std::size_t kFewestPoints = 6; // of an unknown lens
constexpr std::size_t kPlaces = 60;      // of the device in one state, where the error is told
constexpr int kCrossArm = 24;            // pixels of the bright part of the crosshair

QString pixelsText(double pixels) { return QString::number(pixels, 'f', 1); }

QString sentence(const Finding& finding) {
    QString text = QString::fromStdString(finding.why);
    if (!finding.remedy.empty()) text += "; " + QString::fromStdString(finding.remedy);
    if (!text.isEmpty()) text[0] = text[0].toUpper();
    return text + ".";
}

std::optional<std::size_t> mostContradicted(const CrosshairCalibration& result) {
    const auto most = std::ranges::max_element(
        result.points, {}, [](const CrosshairFit& fit) { return fit.suspicious ? fit.contradiction : -1.0; });
    if (most == result.points.end() || !most->suspicious) return std::nullopt;
    return static_cast<std::size_t>(most - result.points.begin());
}

void addPlaces(std::vector<cv::Point3d>& places, const TriangleMesh& mesh) {
    const std::size_t step = std::max<std::size_t>(1, mesh.positions.size() / kPlaces);
    for (std::size_t i = 0; i < mesh.positions.size(); i += step)
        places.emplace_back(mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z);
}

} // namespace

std::size_t CrosshairState::aimed() const {
    if (!session) return 0;
    return static_cast<std::size_t>(std::ranges::count_if(session->crosshairs(), &Crosshair::aimed));
}

std::optional<std::size_t> CrosshairState::open() const {
    if (!session) return std::nullopt;
    const std::size_t count = session->crosshairs().size();
    for (std::size_t k = 1; k <= count; ++k) { // after the current one first, itself last
        const std::size_t index = (current + k) % count;
        if (!session->crosshairs()[index].aimed && !leftOut[index]) return index;
    }
    return std::nullopt;
}

CrosshairNext nextOf(const CrosshairState& state) {
    using Do = CrosshairNext::Do;
    using Tone = CrosshairNext::Tone;
    if (!state.session)
        return {Do::begin, state.trouble.isEmpty() ? Tone::quiet : Tone::failure,
                QObject::tr("There is nothing to aim at yet"), state.trouble, QObject::tr("Try again")};
    const auto& crosshairs = state.session->crosshairs();
    const auto& result = state.session->result();
    const std::size_t aimed = state.aimed();
    if (const auto open = state.open()) {
        const bool isLast = *open == state.current;
        CrosshairNext next{
            Do::confirm, Tone::live,
            QObject::tr("Move the crosshair onto: %1").arg(QString::fromStdString(crosshairs[state.current].name)),
            QObject::tr("Drag it, or press the arrow keys (with Shift ten pixels). All flaps stand "
                        "raised. %1 of %2 points are aimed at.")
                .arg(aimed)
                .arg(crosshairs.size()),
            isLast ? QObject::tr("This is it") : QObject::tr("This is it, next point")};
        if (!state.trouble.isEmpty()) next.tone = Tone::failure, next.text = state.trouble;
        return next;
    }
    if (!result || aimed < kFewestPoints)
        return {Do::nothing,
                Tone::warning,
                QObject::tr("The points do not tell the projector yet"),
                state.session->missing() ? sentence(*state.session->missing()) : QString(),
                {}};
    const auto suspicious = mostContradicted(*result);
    if (result->refusal) {
        CrosshairNext next{Do::nothing,
                           Tone::failure,
                           QObject::tr("The crosshairs contradict one another"),
                           sentence(*result->refusal),
                           {}};
        if (suspicious && *suspicious != state.current)
            next.what = Do::showSuspicious, next.button = QObject::tr("Show the point");
        return next;
    }
    if (!state.usedDate.empty())
        return {Do::nothing,
                Tone::good,
                QObject::tr("The room uses this calibration"),
                QObject::tr("Light lands within %1 mm, in 95 of 100 cases. Undo takes it back.")
                    .arg(state.millimetres.value_or(0.0), 0, 'f', 1),
                {}};
    CrosshairNext next{Do::use, Tone::good, QObject::tr("The projector is known"),
                       QObject::tr("Light lands within %1 mm anywhere on the device, in 95 of 100 cases.")
                           .arg(state.millimetres.value_or(0.0), 0, 'f', 1),
                       QObject::tr("Use this calibration")};
    if (suspicious) {
        next.tone = Tone::warning;
        next.title = QObject::tr("One point does not agree with the others: %1")
                         .arg(QString::fromStdString(crosshairs[*suspicious].name));
    }
    if (!state.trouble.isEmpty()) next.tone = Tone::failure, next.text = state.trouble;
    return next;
}

QString wordsOfPoint(const CrosshairState& state, std::size_t index) {
    if (state.leftOut[index]) return QObject::tr("left out");
    if (!state.session->crosshairs()[index].aimed)
        return index == state.current ? QObject::tr("now") : QObject::tr("to do");
    const auto& result = state.session->result();
    if (!result) return QObject::tr("aimed");
    const CrosshairFit& fit = result->points[index];
    const QString beside = QObject::tr("%1 px beside").arg(pixelsText(cv::norm(fit.error)));
    return fit.suspicious ? QObject::tr("suspicious, %1").arg(beside) : beside;
}

CrosshairService::CrosshairService(StudioDocument& document, Shower show, VersionTaker take, QObject* parent)
    : QObject(parent), document_(document), show_(std::move(show)), take_(std::move(take)) {
    connect(&document, &StudioDocument::changed, this, [this](StateParts parts) {
        if ((parts & StatePart::rig) && active_) begin();
        if (parts & StatePart::installation) followDocument();
    });
}

void CrosshairService::setActive(bool active) {
    if (active == active_) return;
    active_ = active;
    if (active && (!state_.session || rig_ != document_.state().rig.rig)) return begin();
    showPicture();
    emit changed();
}

void CrosshairService::setLab(bool isLab) {
    if (isLab == state_.isLab) return;
    state_.isLab = isLab;
    state_.trouble.clear();
    renderSight();
    showPicture();
    emit changed();
}

void CrosshairService::setProjector(std::size_t projector) {
    if (projector == chosen_) return;
    if (shown_) show_(chosen_, {});
    shown_ = false;
    chosen_ = projector;
    const bool hadBegun = state_.session.has_value();
    const bool isLab = state_.isLab;
    state_ = {};
    state_.isLab = isLab;
    resultDate_.clear();
    if (hadBegun) return begin();
    emit changed();
}

const InstalledProjector* CrosshairService::projector() const {
    const auto& projectors = document_.state().installation->projectors;
    return chosen_ < projectors.size() ? &projectors[chosen_] : nullptr;
}

void CrosshairService::begin() {
    const bool isLab = state_.isLab;
    state_ = {};
    state_.isLab = isLab;
    resultDate_.clear();
    places_.clear();
    rig_ = document_.state().rig.rig;
    try {
        if (!rig_) throw InvalidInput("device", "none is open", "open a device, or a project with one");
        const Installation& room = *document_.state().installation;
        if (projector() == nullptr) throw InvalidInput("projector", "the room has none", "add one in Scene");
        const CalibratedCamera& believed = projector()->camera;
        const glm::dmat4 deviceFromWorld = glm::inverse(glm::dmat4(room.worldFromDevice));
        const glm::dvec3 at(deviceFromWorld * glm::dvec4(positionOf(believed), 1.0));
        const DevicePoints proposal = proposeDevicePoints(*rig_, {at.x, at.y, at.z}, kMostPoints);
        CrosshairSession session({believed.size.x, believed.size.y});
        for (const DevicePoint& point : proposal.points) (void)session.add(point.name, point.point);
        addPlaces(places_, rig_->restMesh());
        addPlaces(places_, deformed(*rig_, proposal.strokes));
        state_.strokes = proposal.strokes;
        state_.leftOut.assign(proposal.points.size(), false);
        state_.session = std::move(session);
        place(0);
    } catch (const std::exception& error) {
        const Notice notice = noticeOf(error);
        state_.trouble = QString("%1: %2; %3.").arg(notice.subject, notice.why, notice.remedy);
    }
    renderSight();
    follow();
}

void CrosshairService::doNext() {
    switch (nextOf(state_).what) {
    case CrosshairNext::Do::begin:
        return begin();
    case CrosshairNext::Do::confirm:
        return confirm();
    case CrosshairNext::Do::showSuspicious:
        if (const auto index = mostContradicted(*state_.session->result())) select(*index);
        return;
    case CrosshairNext::Do::use:
        return use();
    case CrosshairNext::Do::nothing:
        return;
    }
}

/// Where the others put it, until somebody aims it. While they do not tell, it stays in the middle, where it proves
/// nothing: what the room believes would only confirm itself.
void CrosshairService::place(std::size_t index) {
    CrosshairSession& session = *state_.session;
    const Crosshair& crosshair = session.crosshairs()[index];
    if (crosshair.aimed) return;
    std::optional<cv::Point2d> guess;
    if (session.result()) {
        guess = session.result()->pixelOf(crosshair.point);
    }
    if (!guess || !std::isfinite(guess->x) || !std::isfinite(guess->y)) return;
    session.aimAt(index, {std::round(guess->x), std::round(guess->y)});
    session.setAimed(index, false);
}

void CrosshairService::select(std::size_t index) {
    if (!state_.session || index >= state_.session->crosshairs().size()) return;
    state_.current = index;
    place(index);
    showPicture();
    emit changed();
}

void CrosshairService::moveBy(const QPointF& by) {
    if (!state_.session) return;
    const cv::Point2d at = state_.session->crosshairs()[state_.current].pixel;
    moveTo({at.x + by.x(), at.y + by.y()});
}

void CrosshairService::moveTo(const QPointF& pixel) {
    if (!state_.session) return;
    // Whole pixels alone can be shown.
    state_.session->aimAt(state_.current, {std::round(pixel.x()), std::round(pixel.y())});
    state_.leftOut[state_.current] = false;
    follow();
}

void CrosshairService::confirm() {
    if (!state_.session) return;
    state_.session->setAimed(state_.current, true);
    state_.leftOut[state_.current] = false;
    if (const auto next = state_.open()) {
        state_.current = *next;
        place(*next);
    }
    follow();
}

void CrosshairService::setLeftOut(std::size_t index, bool leftOut) {
    if (!state_.session || index >= state_.leftOut.size() || state_.leftOut[index] == leftOut) return;
    state_.leftOut[index] = leftOut;
    if (leftOut) state_.session->setAimed(index, false);
    if (leftOut && index == state_.current)
        if (const auto next = state_.open()) {
            state_.current = *next;
            place(*next);
        }
    follow();
}

/// Another solution.
void CrosshairService::follow() {
    state_.millimetres.reset();
    state_.usedDate.clear();
    resultDate_.clear();
    if (state_.session && state_.session->result()) {
        double worst = 0.0;
        for (const cv::Point3d& at : places_) worst = std::max(worst, state_.session->result()->error95At(at));
        if (std::isfinite(worst)) state_.millimetres = 1000.0 * worst;
    }
    showPicture();
    emit changed();
}

void CrosshairService::use() {
    const auto& result = state_.session ? state_.session->result() : std::nullopt;
    if (!result || result->refusal) return;
    try {
        InstallationVersion version;
        version.date = utcDate();
        version.title = "Projector by crosshairs, without a camera";
        const std::size_t points = state_.aimed();
        if (state_.millimetres) version.figures.push_back({"Light lands within", *state_.millimetres, "mm"});
        version.figures.push_back({"Projector error", result->projector.rms, "px"});
        version.figures.push_back({"Projector focal", result->projector.lens[kFocalLength], "px"});
        version.figures.push_back({"Points", static_cast<double>(points), ""});
        for (const Crosshair& crosshair : state_.session->crosshairs())
            if (crosshair.aimed) version.inputs.push_back(crosshair.name);
        version.installation = withCrosshairs(*document_.state().installation, *result, points, chosen_, version.date);
        if (take_(version)) {
            state_.trouble.clear();
            resultDate_ = version.date;
            followDocument();
        }
    } catch (const std::exception& error) {
        const Notice notice = noticeOf(error);
        state_.trouble = QString("%1: %2; %3.").arg(notice.subject, notice.why, notice.remedy);
    }
    emit changed();
}

/// Undo takes a calibration out of the room, redo puts it back.
void CrosshairService::followDocument() {
    std::string used;
    if (!resultDate_.empty() && projector() != nullptr && projector()->pose.date == resultDate_) used = resultDate_;
    if (used == state_.usedDate) return;
    state_.usedDate = used;
    emit changed();
}

QImage CrosshairService::picture() const {
    if (!state_.session || projector() == nullptr) return {};
    const glm::ivec2 size = projector()->camera.size;
    QImage picture(size.x, size.y, QImage::Format_RGB32);
    picture.fill(Qt::black);
    const cv::Point2d pixel = state_.session->crosshairs()[state_.current].pixel;
    const int x = static_cast<int>(std::lround(pixel.x)), y = static_cast<int>(std::lround(pixel.y));
    QPainter painter(&picture);
    painter.fillRect(0, y, size.x, 1, QColor(110, 110, 110));
    painter.fillRect(x, 0, 1, size.y, QColor(110, 110, 110));
    painter.fillRect(x - kCrossArm, y, 2 * kCrossArm + 1, 1, Qt::white);
    painter.fillRect(x, y - kCrossArm, 1, 2 * kCrossArm + 1, Qt::white);
    return picture;
}

void CrosshairService::showPicture() {
    const bool wanted = active_ && !state_.isLab && state_.session;
    if (!wanted && !shown_) return;
    shown_ = wanted;
    try {
        show_(chosen_, wanted ? picture() : QImage());
        if (wanted) state_.trouble.clear();
    } catch (const std::exception& error) {
        const Notice notice = noticeOf(error);
        state_.trouble = QString("%1: %2; %3.").arg(notice.subject, notice.why, notice.remedy);
    }
}

QPointF CrosshairService::target() const {
    if (!state_.session) return {};
    const cv::Point3d& point = state_.session->crosshairs()[state_.current].point;
    const glm::dmat4 worldFromDevice(document_.state().installation->worldFromDevice);
    const auto pixel = pixelOf(sightCamera_, glm::dvec3(worldFromDevice * glm::dvec4(point.x, point.y, point.z, 1.0)));
    return pixel ? QPointF(pixel->x, pixel->y) : QPointF(-1.0, -1.0);
}

/// Triangles from the farthest to the nearest.
void CrosshairService::renderSight() {
    sight_ = {};
    const InstalledProjector* installed = projector();
    if (!state_.session || installed == nullptr) return;
    const Installation& room = *document_.state().installation;
    sightCamera_ = state_.isLab ? labTruth(room, chosen_).projectors.front().camera : installed->camera;
    const CalibratedCamera& projector = sightCamera_;
    const TriangleMesh mesh = deformed(*rig_, state_.strokes);
    struct Facet {
        double distance;
        double light;
        QPolygonF outline;
    };
    std::vector<Facet> facets;
    const glm::dvec3 from = positionOf(projector);
    for (const auto& triangle : mesh.triangles) {
        glm::dvec3 corners[3];
        QPolygonF outline;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 device(mesh.positions[triangle[k]]);
            corners[k] = glm::dvec3(glm::dmat4(room.worldFromDevice) * glm::dvec4(device, 1.0));
            // Pixel centres lie at whole numbers there, at halves for the painter.
            if (const auto pixel = pixelOf(projector, corners[k])) outline << QPointF(pixel->x + 0.5, pixel->y + 0.5);
        }
        const glm::dvec3 way = (corners[0] + corners[1] + corners[2]) / 3.0 - from;
        const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double length = glm::length(normal);
        const double facing = length > 0.0 ? -glm::dot(normal, glm::normalize(way)) / length : 0.0;
        if (outline.size() == 3 && facing > 0.0) facets.push_back({glm::length(way), facing, outline});
    }
    std::ranges::sort(facets, std::greater{}, &Facet::distance);
    QImage sight(projector.size.x, projector.size.y, QImage::Format_RGB32);
    sight.fill(QColor(24, 24, 26));
    QPainter painter(&sight);
    painter.setRenderHint(QPainter::Antialiasing);
    for (const Facet& facet : facets) {
        const int grey = static_cast<int>(40.0 + 110.0 * std::pow(facet.light, 3.0));
        const QColor color(grey, grey, grey);
        painter.setBrush(color);
        painter.setPen(QPen(color, 0.5));
        painter.drawPolygon(facet.outline);
    }
    painter.end();
    sight_ = sight;
}

} // namespace lumorph::studio
