#include "calibration/tracking/board_watch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <glm/gtc/quaternion.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kPoorFit = 1.5;     // pixels
constexpr double kTooDark = 45.0;    // mean of 0..255
constexpr double kTooBright = 235.0; // the same
constexpr double kTooSoft = 12.0;    // variance of the Laplacian: nothing in the picture has an edge
constexpr int kLooksForPlace = 5;    // sightings, the steadiest of which counts
constexpr int kLostAfter = 15;       // pictures, after which the last pose says nothing of the next

CalibratedCamera cameraOf(const BoardAddress& address, glm::ivec2 size) {
    CalibratedCamera camera;
    camera.size = size;
    if (address.lens) {
        camera.focal = {address.lens->fx, address.lens->fy};
        camera.principal = {address.lens->cx, address.lens->cy};
        camera.distortion = address.lens->distortion;
    } else {
        const double half = 0.5 * address.fieldOfViewDegrees * M_PI / 180.0;
        camera.focal = glm::dvec2(0.5 * size.x / std::tan(half));
        camera.principal = 0.5 * glm::dvec2(size) - 0.5;
    }
    if (address.place)
        camera.cameraFromWorld =
            cameraLookingAt(address.place->from, address.place->to, size, camera.focal.x).cameraFromWorld;
    return camera;
}

/// The board lies on the body: its page up, its middle over the body's middle, its lower edge towards who stands
/// before it.
Pose bodyFromBoardOf(const BoardAddress& address) {
    const glm::dvec2 size = sizeOf(address.board);
    return {{-0.5 * size.x, 1e-3 * address.aboveMillimetres, 0.5 * size.y},
            glm::angleAxis(-M_PI / 2.0, glm::dvec3(1.0, 0.0, 0.0))};
}

/// Metres, seen in pixels, in the picture.
cv::Point2d seenAt(const CalibratedCamera& camera, const Pose& cameraFromBoard, const glm::dvec3& point, double scale) {
    CalibratedCamera here = camera;
    here.cameraFromWorld = matrixOf(cameraFromBoard);
    const auto pixel = pixelOf(here, point);
    return pixel ? cv::Point2d(scale * pixel->x, scale * pixel->y) : cv::Point2d(-1.0, -1.0);
}

std::string troubleOf(const cv::Mat& grey, int corners) {
    if (corners > 0)
        return "Only " + std::to_string(corners) + " corners of the board are in the picture. Show more of it.";
    const double light = cv::mean(grey)[0];
    if (light < kTooDark) return "The picture is too dark to see the board. Give more light.";
    if (light > kTooBright)
        return "The picture is too bright to see the board. Give less light, or close the aperture.";
    cv::Mat edges;
    cv::Laplacian(grey, edges, CV_16S);
    cv::Scalar mean, spread;
    cv::meanStdDev(edges, mean, spread);
    if (spread[0] * spread[0] < kTooSoft)
        return "The picture is blurred or covered. Focus the camera, hold the board still, clean the lens.";
    return "The board is not in the picture. Turn it to the camera, and check that its squares and dictionary are "
           "those "
           "of the address.";
}

} // namespace

struct BoardWatch::Data {
    explicit Data(const BoardAddress& which) : address(which), bodyFromBoard(bodyFromBoardOf(which)) {
        checkBoard(address.board);
    }

    void prepare(glm::ivec2 size);
    void learnPlace(const BoardSighting& sighting);
    [[nodiscard]] bool knowsPlace() const { return address.place || placed; }

    BoardAddress address;
    Pose bodyFromBoard;
    CalibratedCamera camera;
    std::optional<BoardFinder> finder;
    cv::Mat grey;
    std::optional<BoardSighting> last; ///< in the newest picture
    std::optional<Pose> hint;          ///< the newest pose, while it is not old
    int missed = 0;
    int looks = 0; ///< sightings before the place was learnt
    double bestFit = 0.0;
    std::optional<Pose> bestSeen;
    bool placed = false;
};

void BoardWatch::Data::prepare(glm::ivec2 size) {
    if (finder && camera.size == size) return;
    const glm::dmat4 before = camera.cameraFromWorld;
    camera = cameraOf(address, size);
    if (placed) camera.cameraFromWorld = before;
    finder.emplace(address.board, camera);
}

/// Of the first sightings the one that fits best: there the body is at the world's origin, upright.
void BoardWatch::Data::learnPlace(const BoardSighting& sighting) {
    if (!bestSeen || sighting.reprojectionError < bestFit) {
        bestSeen = sighting.cameraFromBoard;
        bestFit = sighting.reprojectionError;
    }
    if (++looks < kLooksForPlace) return;
    camera.cameraFromWorld = matrixOf(*bestSeen) * glm::inverse(matrixOf(bodyFromBoard));
    placed = true;
}

BoardWatch::BoardWatch(const BoardAddress& address) : data_(std::make_unique<Data>(address)) {}
BoardWatch::~BoardWatch() = default;

BoardView BoardWatch::look(const cv::Mat& picture) {
    Data& d = *data_;
    if (picture.empty()) throw InvalidInput("camera picture", "it has no extent", "use another camera");
    if (picture.channels() == 1)
        picture.copyTo(d.grey);
    else
        cv::cvtColor(picture, d.grey, cv::COLOR_BGR2GRAY);
    if (!d.grey.isContinuous()) d.grey = d.grey.clone();
    d.prepare({d.grey.cols, d.grey.rows});
    BoardView view;
    view.sighting = d.finder->find({d.grey.ptr<std::uint8_t>(), d.grey.total()}, d.hint);
    d.last = view.sighting;
    if (!view.sighting) {
        if (++d.missed >= kLostAfter) d.hint.reset();
        view.advice = troubleOf(d.grey, d.finder->cornersSeen());
        return view;
    }
    d.missed = 0;
    d.hint = view.sighting->cameraFromBoard;
    if (!d.knowsPlace()) d.learnPlace(*view.sighting);
    if (d.knowsPlace()) view.world = worldFromDevice(*view.sighting, d.camera, d.bodyFromBoard);
    if (view.sighting->reprojectionError > kPoorFit)
        view.advice =
            "The board does not fit its picture well. Print it flat at its true size, check size and marker " +
            std::string(d.address.lens ? "in the address, and calibrate the camera anew."
                                       : "in the address, and give the camera's lens or fov.");
    return view;
}

Image BoardWatch::preview(int width) const {
    const Data& d = *data_;
    if (d.grey.empty()) return {};
    const double scale = std::min(1.0, static_cast<double>(width) / d.grey.cols);
    cv::Mat small, drawn;
    cv::resize(d.grey, small, {}, scale, scale, cv::INTER_AREA);
    cv::cvtColor(small, drawn, cv::COLOR_GRAY2RGBA);
    if (d.last) {
        const glm::dvec2 size = sizeOf(d.address.board);
        const glm::dvec3 right(size.x, 0.0, 0.0), up(0.0, size.y, 0.0);
        const auto at = [&](const glm::dvec3& p) { return seenAt(d.camera, d.last->cameraFromBoard, p, scale); };
        const auto line = [&](const glm::dvec3& a, const glm::dvec3& b, const cv::Scalar& color) {
            cv::line(drawn, at(a), at(b), color, 2, cv::LINE_AA);
        };
        const std::array<glm::dvec3, 4> corners{glm::dvec3(0.0), right, right + up, up};
        for (std::size_t i = 0; i < 4; ++i) line(corners[i], corners[(i + 1) % 4], {255, 190, 40, 255});
        const double length = 0.4 * std::min(right.x, up.y);
        const glm::dvec3 middle = 0.5 * (right + up);
        line(middle, middle + glm::dvec3(length, 0, 0), {224, 85, 85, 255});
        line(middle, middle + glm::dvec3(0, length, 0), {76, 176, 90, 255});
        line(middle, middle + glm::dvec3(0, 0, length), {85, 140, 240, 255});
    }
    Image image({drawn.cols, drawn.rows});
    std::copy_n(drawn.ptr<Image::Pixel::value_type>(), drawn.total() * 4,
                reinterpret_cast<std::uint8_t*>(image.pixels().data()));
    return image;
}

std::string BoardWatch::assumptions() const {
    const Data& d = *data_;
    std::string text;
    if (!d.address.lens) {
        char fov[64];
        std::snprintf(fov, sizeof fov, "%g", d.address.fieldOfViewDegrees);
        text = "The lens is not calibrated: it is taken to see " + std::string(fov) +
               " degrees from left to right, and distances are as wrong as that is. Give lens= or fov= in the address.";
    }
    if (!d.address.place)
        text += std::string(text.empty() ? "" : " ") + "Where the board " + (d.placed ? "was" : "is") +
                " seen first counts as the middle of the world.";
    return text;
}

} // namespace lumorph
