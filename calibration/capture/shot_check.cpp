#include "calibration/capture/shot_check.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "calibration/decode/pattern_decoder.h"
#include "calibration/doctor/sequence_check.h"
#include "calibration/doctor/view_check.h"
#include "calibration/patterns/gray_code.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr int kEveryPixel = 2;          // along both sides, of those that are looked at
constexpr double kLeastSwitched = 12.0; // grey levels between light and dark, for a pixel to count
constexpr double kDimSwitched = 40.0;   // of the brightest tenth: below, noise shows in the result
constexpr double kStrange = 0.08;       // of the light that is switched: above, a set makes no even light
constexpr double kResolved = 0.25;      // of that light: what a stripe switches at least where it is resolved
constexpr double kSameShot = 0.05;      // below, two shots show the same
constexpr double kNotLate = 0.08;       // of the weights of a pair, beside their sum
constexpr double kDriftTold = 0.03;     // of the exposure
constexpr double kDriftRefused = 0.12;
constexpr int kFullGrey = 254;
constexpr double kBurntTold = 0.04; // of the pixels that count
constexpr double kBurntRefused = 0.3;
constexpr double kShifted = 0.6;      // camera pixels, of a corner
constexpr double kShiftedShare = 0.3; // of all corners
constexpr std::size_t kFewestCorners = 8;

const char* const kTakeAgain = "capture this pose again";
const char* const kSettleLonger = "let the projector settle longer before each shot, and capture this pose again";

/// Images of an order that make even light together: a pattern and its inverse, the steps of a phase set, white and
/// black.
std::vector<std::vector<int>> evenSetsOf(const CaptureOrder& order) {
    std::vector<std::vector<int>> sets;
    std::vector<bool> taken(order.images.size(), false);
    const auto belongsTo = [](const PatternImage& one, const PatternImage& other) {
        if (const auto* a = std::get_if<GrayBit>(&one))
            if (const auto* b = std::get_if<GrayBit>(&other)) return a->axis == b->axis && a->bit == b->bit;
        if (const auto* a = std::get_if<PhaseStep>(&one))
            if (const auto* b = std::get_if<PhaseStep>(&other))
                return a->axis == b->axis && a->periods == b->periods && a->steps == b->steps;
        return std::holds_alternative<FlatField>(one) && std::holds_alternative<FlatField>(other);
    };
    for (std::size_t i = 0; i < order.images.size(); ++i) {
        if (taken[i] || std::holds_alternative<UnusedImage>(order.images[i])) continue;
        std::vector<int> set;
        for (std::size_t k = i; k < order.images.size(); ++k)
            if (!taken[k] && belongsTo(order.images[i], order.images[k])) {
                set.push_back(static_cast<int>(k));
                taken[k] = true;
            }
        const auto* phase = std::get_if<PhaseStep>(&order.images[i]);
        if (set.size() == (phase != nullptr ? static_cast<std::size_t>(phase->steps) : 2U)) sets.push_back(set);
    }
    return sets;
}

/// Every second pixel of every second row; patterns finer than that are as good in what is left.
cv::Mat1f thinned(const cv::Mat& grey) {
    cv::Mat1f few((grey.rows + kEveryPixel - 1) / kEveryPixel, (grey.cols + kEveryPixel - 1) / kEveryPixel);
    for (int y = 0; y < few.rows; ++y)
        for (int x = 0; x < few.cols; ++x) few(y, x) = grey.at<uchar>(y * kEveryPixel, x * kEveryPixel);
    return few;
}

double percentileOf(const cv::Mat1f& values, const cv::Mat1b& mask, double share) {
    std::vector<float> all;
    for (int y = 0; y < values.rows; ++y)
        for (int x = 0; x < values.cols; ++x)
            if (mask.empty() || mask(y, x) != 0) all.push_back(values(y, x));
    if (all.empty()) return 0.0;
    const auto at = all.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(all.size() - 1));
    std::nth_element(all.begin(), at, all.end());
    return *at;
}

/// Corners of what is seen, that can be found again.
std::vector<cv::Point2f> cornersOf(const cv::Mat1b& image, const cv::Mat1b& mask) {
    std::vector<cv::Point2f> corners;
    cv::goodFeaturesToTrack(image, corners, 150, 0.05, 12.0, mask, 5);
    return corners;
}

void refineCorners(const cv::Mat1b& image, std::vector<cv::Point2f>& corners) {
    if (corners.empty()) return;
    cv::cornerSubPix(image, corners, {5, 5}, {-1, -1}, {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 20, 0.02});
}

/// Whether the same share of `way` lies in `off` all over `place`, not in one part: a hand is not a late picture.
bool isEverywhere(const cv::Mat1f& off, const cv::Mat1f& way, double share, const cv::Rect& place) {
    constexpr int kTiles = 5; // along both sides
    int all = 0;
    int alike = 0;
    const double whole = way.dot(way);
    for (int y = 0; y < kTiles; ++y)
        for (int x = 0; x < kTiles; ++x) {
            const cv::Rect tile(place.tl() + cv::Point(place.width * x / kTiles, place.height * y / kTiles),
                                place.tl() +
                                    cv::Point(place.width * (x + 1) / kTiles, place.height * (y + 1) / kTiles));
            const cv::Mat1f wayHere = way(tile);
            const double here = wayHere.dot(wayHere);
            if (here < 0.2 * whole / (kTiles * kTiles)) continue;
            ++all;
            alike += cv::Mat1f(off(tile)).dot(wayHere) > 0.5 * share * here;
        }
    return alike * 10 > 7 * all;
}

/// Sine of the angle from the way in which the projector's columns grow in the camera to that of its rows; negative in
/// a mirror image.
double turnOf(const DecodedView& decoded) {
    const cv::Mat1b known = (decoded.column == decoded.column) & (decoded.row == decoded.row); // not NaN
    std::vector<cv::Point> places;
    cv::findNonZero(known, places);
    if (places.size() < 50) return 1.0;
    cv::Mat1d here(static_cast<int>(places.size()), 3), there(here.rows, 2), fit;
    for (int i = 0; i < here.rows; ++i) {
        const cv::Point& place = places[static_cast<std::size_t>(i)];
        here(i, 0) = place.x;
        here(i, 1) = place.y;
        here(i, 2) = 1.0;
        there(i, 0) = decoded.column(place);
        there(i, 1) = decoded.row(place);
    }
    if (!cv::solve(here, there, fit, cv::DECOMP_NORMAL | cv::DECOMP_CHOLESKY)) return 1.0;
    const cv::Point2d column(fit(0, 0), fit(1, 0)), row(fit(0, 1), fit(1, 1));
    return column.cross(row) / std::max(1e-12, cv::norm(column) * cv::norm(row));
}

std::string percentWords(double share) { return std::to_string(std::lround(100.0 * share)) + " %"; }

} // namespace

struct ShotCheck::Data {
    CaptureOrder order;
    std::string name;
    std::optional<CalibrationBoard> board;
    std::vector<std::vector<int>> sets;

    std::vector<cv::Mat> images;
    std::vector<std::string> files;
    ShotFindings findings;
    cv::Mat1b evenLight;

    // Of the first even light, thinned.
    cv::Mat1f even, switched;
    cv::Mat1b lit;    ///< by the projector
    cv::Mat1b counts; ///< where exposure counts: the board, or all that is lit
    std::vector<cv::Point2f> corners;
    std::vector<cv::Point2d> onBoard;    ///< the board's points, in the picture; empty where none is looked for
    double gainNow = 1.0;                ///< of the last pair, beside the first
    std::map<std::size_t, double> gains; ///< of the first set of so many images: a gamma makes phase sets darker
    bool isBurntTold = false, isDriftTold = false;
    std::optional<cv::Point2d> columnWay, rowWay; ///< in the camera, towards larger columns and rows

    void refuse(Cause cause, const std::string& file, std::string why, std::string remedy = kTakeAgain) {
        if (!findings.refusal) findings.refusal = Finding{cause, name, file, std::move(why), std::move(remedy)};
    }
    void warn(Cause cause, const std::string& file, std::string why, std::string remedy) {
        findings.warnings.push_back({cause, name, file, std::move(why), std::move(remedy)});
    }
    void refuseMirrored(const std::string& file) {
        refuse(Cause::mirrored, file, "camera and projector see mirror images of each other",
               "switch off mirroring (rear projection) in projector and camera; check that columns come before rows");
    }
    void refuseMoved(const std::vector<int>& set) {
        refuse(Cause::rigMoved, file(set.back()), "camera, board or projector moved within this pose",
               "fix all of them, then capture this pose again");
    }
    [[nodiscard]] const PatternImage& pattern(int image) const { return order.images[static_cast<std::size_t>(image)]; }
    [[nodiscard]] const cv::Mat& shot(int image) const { return images[static_cast<std::size_t>(image)]; }
    [[nodiscard]] const std::string& file(int image) const { return files[static_cast<std::size_t>(image)]; }

    void takeReference(const cv::Mat1f& light, const cv::Mat1f& change, const cv::Mat1b& picture);
    void takeBoard();
    void lookAtExposure(const cv::Mat& image, const std::string& file);
    void lookAtSet(const std::vector<int>& set);
    void lookAtWay(const std::vector<int>& set);
    void explainStrange(const std::vector<int>& set, const cv::Mat1f& mean, double gain);
    [[nodiscard]] bool isLightChanged(const std::vector<int>& pair);
    [[nodiscard]] cv::Mat1f onLit(const cv::Mat1f& values) const;
    [[nodiscard]] bool isEdgesAlone(const cv::Mat1f& off) const;
    [[nodiscard]] double explainedByEarlier(int image, double gain) const;
    [[nodiscard]] double differenceOf(const cv::Mat1f& one, const cv::Mat1f& other) const;
    [[nodiscard]] bool hasMoved(const cv::Mat1b& picture) const;
};

/// Mean distance, of the light that is switched.
double ShotCheck::Data::differenceOf(const cv::Mat1f& one, const cv::Mat1f& other) const {
    const cv::Mat1f share = cv::abs(one - other) / switched;
    return cv::mean(share, lit)[0];
}

bool ShotCheck::Data::hasMoved(const cv::Mat1b& picture) const {
    if (corners.size() < kFewestCorners) return false;
    std::vector<cv::Point2f> now = corners;
    refineCorners(picture, now);
    std::size_t shifted = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) shifted += cv::norm(now[i] - corners[i]) > kShifted;
    return static_cast<double>(shifted) > kShiftedShare * static_cast<double>(corners.size());
}

void ShotCheck::Data::takeReference(const cv::Mat1f& light, const cv::Mat1f& change, const cv::Mat1b& picture) {
    even = light;
    evenLight = picture;
    switched = cv::max(change, 1.0F);
    const double bright = percentileOf(change, {}, 0.98);
    lit = change > std::max(kLeastSwitched, 0.3 * bright);
    counts = lit;
    if (cv::countNonZero(lit) * 200 < static_cast<int>(lit.total())) {
        refuse(Cause::boardUnlit, "", "the camera hardly sees the projector's light",
               "point the camera at what the projector lights, expose for longer, darken the room");
        return;
    }
    cv::Mat1b whole;
    cv::resize(lit, whole, picture.size(), 0.0, 0.0, cv::INTER_NEAREST);
    corners = cornersOf(picture, whole);
    refineCorners(picture, corners);
    if (board) takeBoard();
    if (findings.refusal) return;
    if (const double dim = percentileOf(change, counts, 0.75); dim < kDimSwitched)
        warn(Cause::underexposed, "",
             "light and dark differ by only " + std::to_string(std::lround(dim)) + " grey levels",
             "expose for longer, open the aperture, or darken the room");
}

void ShotCheck::Data::takeBoard() {
    const std::optional<BoardPoints> found = findBoard(evenLight, *board);
    if (!found) {
        refuse(Cause::boardNotFound, "", "the board cannot be found",
               "check which board was named, and that all of it is lit, sharp and in the picture");
        return;
    }
    std::vector<cv::Point> points, hull;
    for (const cv::Point2d& point : found->seen)
        points.emplace_back(cvRound(point.x / kEveryPixel), cvRound(point.y / kEveryPixel));
    cv::convexHull(points, hull);
    cv::Mat1b inside = cv::Mat1b::zeros(lit.size());
    cv::fillConvexPoly(inside, hull, cv::Scalar(255));
    counts = inside & lit;
    if (cv::countNonZero(counts) * 2 < cv::countNonZero(inside)) {
        // Black squares switch little; more than they lie in the dark.
        const cv::Mat1b dark = inside & (switched < kLeastSwitched);
        if (cv::countNonZero(dark) * 10 > 7 * cv::countNonZero(inside))
            refuse(Cause::boardUnlit, "", "the projector's light does not reach most of the board",
                   "bring the board into the projector's light");
    }
    // What is on the board tells more of its motion than the room around it.
    onBoard = found->seen;
    corners.assign(onBoard.begin(), onBoard.end());
    refineCorners(evenLight, corners);
}

void ShotCheck::Data::lookAtExposure(const cv::Mat& image, const std::string& file) {
    if (counts.empty()) return;
    const int all = cv::countNonZero(counts);
    if (all == 0) return;
    const cv::Mat1b burnt = counts & (thinned(image) >= kFullGrey);
    const double share = static_cast<double>(cv::countNonZero(burnt)) / all;
    const std::string why =
        percentWords(share) + (board ? " of the board's light" : " of what is lit") + " is overexposed in this shot";
    const char* const remedy = "expose for a shorter time, or close the aperture";
    if (share > kBurntRefused) {
        refuse(Cause::clipped, file, why, remedy);
    } else if (share > kBurntTold && !isBurntTold) {
        warn(Cause::clipped, file, why, remedy);
        isBurntTold = true;
    }
}

/// `values` where the projector lights, 0 elsewhere.
cv::Mat1f ShotCheck::Data::onLit(const cv::Mat1f& values) const {
    cv::Mat1f kept = cv::Mat1f::zeros(values.size());
    values.copyTo(kept, lit);
    return kept;
}

/// Edges that moved are bright on one side and dark on the other; light that is wrong is so over an area.
bool ShotCheck::Data::isEdgesAlone(const cv::Mat1f& off) const {
    const cv::Rect place = cv::boundingRect(lit);
    const int side = std::max(5, std::min(place.width, place.height) / 6) | 1;
    cv::Mat1f sum, count, ones;
    lit.convertTo(ones, CV_32F, 1.0 / 255.0);
    cv::boxFilter(off, sum, CV_32F, {side, side});
    cv::boxFilter(ones, count, CV_32F, {side, side});
    const cv::Mat1f calm = onLit(sum / cv::max(count, 0.05));
    return calm.dot(calm) < 0.2 * off.dot(off);
}

/// How much of a shot is a sum of the three before it.
double ShotCheck::Data::explainedByEarlier(int image, double gain) const {
    const auto patternOf = [&](int i) { return cv::Mat1f(onLit(thinned(shot(i)) - gain * even)); };
    const cv::Mat1f here = patternOf(image);
    std::vector<cv::Mat1f> earlier;
    for (int i = image - 1; i >= std::max(0, image - 3); --i) earlier.push_back(patternOf(i));
    if (earlier.empty()) return 0.0;
    const auto count = static_cast<int>(earlier.size());
    cv::Mat1d products(count, count), right(count, 1), shares;
    for (int i = 0; i < count; ++i) {
        const cv::Mat1f& one = earlier[static_cast<std::size_t>(i)];
        right(i) = one.dot(here);
        for (int k = 0; k < count; ++k) products(i, k) = one.dot(earlier[static_cast<std::size_t>(k)]);
    }
    // A pattern and its inverse are nearly the same but for the sign: the shortest solution shares them out.
    cv::solve(products, right, shares, cv::DECOMP_SVD);
    cv::Mat1f left = here.clone();
    for (int i = 0; i < count; ++i) left -= shares(i) * earlier[static_cast<std::size_t>(i)];
    return 1.0 - left.dot(left) / std::max(1.0, here.dot(here));
}

/// A pattern and its inverse that make even light again once each is made brighter or darker as a whole. So does a
/// share of the first that is still seen in the second, but then the two weights have the sum that they should have.
bool ShotCheck::Data::isLightChanged(const std::vector<int>& pair) {
    const cv::Mat1f first = onLit(thinned(shot(pair[0]))), second = onLit(thinned(shot(pair[1])));
    const cv::Mat1f wanted = onLit(2.0 * gainNow * even);
    const cv::Matx22d products(first.dot(first), first.dot(second), first.dot(second), second.dot(second));
    if (cv::determinant(products) < 1e-3 * products(0, 0) * products(1, 1)) return false; // the same picture twice
    const cv::Vec2d weights = products.solve(cv::Vec2d(first.dot(wanted), second.dot(wanted)), cv::DECOMP_LU);
    if (std::min(weights[0], weights[1]) < 0.1 || std::abs(weights[0] + weights[1] - 2.0) < kNotLate) return false;
    const cv::Mat1f weighted = weights[0] * first + weights[1] * second;
    if (differenceOf(0.5 * weighted, 0.5 * wanted) > 0.5 * kStrange) return false;
    const double brighter = weights[0] / weights[1]; // the second, beside the first
    refuse(Cause::exposureDrifts, file(pair[1]),
           "is " + percentWords(std::abs(brighter - 1.0)) + (brighter > 1.0 ? " brighter" : " darker") +
               " than the pattern before: the exposure or the light changes",
           "switch automatic exposure and the screen's night light off, and capture this pose again");
    return true;
}

void ShotCheck::Data::explainStrange(const std::vector<int>& set, const cv::Mat1f& mean, double gain) {
    for (const int image : set)
        if (image > 0 && differenceOf(thinned(shot(image)), thinned(shot(image - 1))) < kSameShot) {
            refuse(Cause::lateFrame, file(image), "shows the pattern before its own", kSettleLonger);
            return;
        }
    if (set.size() == 2 && isLightChanged(set)) return;
    if (isEdgesAlone(onLit((mean - gain * even) / switched))) {
        refuseMoved(set);
        return;
    }
    const cv::Rect place = cv::boundingRect(lit);
    // What a shot should have been follows from the others of its set; how much of the one before is mixed in?
    for (const int image : set) {
        if (image == 0) continue;
        const cv::Mat1f here = thinned(shot(image));
        const cv::Mat1f own = here + static_cast<double>(set.size()) * (gain * even - mean);
        const cv::Mat1f off = onLit(here - own);
        const cv::Mat1f way = onLit(thinned(shot(image - 1)) - own);
        const double share = off.dot(way) / std::max(1.0, way.dot(way));
        const cv::Mat1f left = off - share * way;
        if (share > 0.05 && share < 1.2 && left.dot(left) < 0.4 * off.dot(off) &&
            isEverywhere(off, way, share, place)) {
            refuse(Cause::lateFrame, file(image), "still shows " + percentWords(share) + " of the pattern before",
                   kSettleLonger);
            return;
        }
    }
    if (explainedByEarlier(set.front(), gain) > 0.6)
        refuse(Cause::lateFrame, file(set.front()), "shows patterns before its own", kSettleLonger);
    else
        refuse(Cause::wrongOrder, file(set.back()), "does not make even light with the others of its set",
               "check that nobody stepped into the light, and the order of the patterns");
}

/// Which way the projector's columns or rows run in the camera: the coarsest stripe lights its far side.
void ShotCheck::Data::lookAtWay(const std::vector<int>& set) {
    const auto* bit = std::get_if<GrayBit>(&pattern(set.front()));
    if (bit == nullptr) return;
    const int length = bit->axis == PatternAxis::columns ? order.projector.width : order.projector.height;
    auto& way = bit->axis == PatternAxis::columns ? columnWay : rowWay;
    if (bit->bit != grayCodeBits(length) - 1 || way) return;
    cv::Mat1f change = thinned(shot(set[0])) - thinned(shot(set[1]));
    if (bit->inverse) change = -change;
    const cv::Moments far = cv::moments(lit & (change > 0.5 * switched), true);
    const cv::Moments near = cv::moments(lit & (change < -0.5 * switched), true);
    const double enough = 0.02 * cv::countNonZero(lit);
    if (far.m00 < enough || near.m00 < enough) return;
    way = cv::Point2d(far.m10 / far.m00 - near.m10 / near.m00, far.m01 / far.m00 - near.m01 / near.m00);
    if (!columnWay || !rowWay) return;
    const double turn = columnWay->cross(*rowWay) / (cv::norm(*columnWay) * cv::norm(*rowWay));
    if (turn < -0.3) refuseMirrored(file(set.front()));
}

void ShotCheck::Data::lookAtSet(const std::vector<int>& set) {
    cv::Mat1f sum = cv::Mat1f::zeros(shot(set.front()).size());
    for (const int image : set) cv::accumulate(shot(image), sum);
    cv::Mat1b picture;
    sum.convertTo(picture, CV_8U, 1.0 / static_cast<double>(set.size()));
    cv::Mat1f least = thinned(shot(set.front()));
    cv::Mat1f most = least.clone();
    cv::Mat1f mean = cv::Mat1f::zeros(least.size());
    for (const int image : set) {
        const cv::Mat1f here = thinned(shot(image));
        least = cv::min(least, here);
        most = cv::max(most, here);
        mean += here / static_cast<double>(set.size());
    }
    if (even.empty()) takeReference(mean, most - least, picture);
    if (findings.refusal) return;
    // Of stripes that the camera does not resolve, it makes a light of its own.
    if (differenceOf(most, least) < kResolved) {
        if (hasMoved(picture)) refuseMoved(set);
        return;
    }
    const double gain = cv::mean(mean, lit)[0] / std::max(1.0, cv::mean(even, lit)[0]);
    if (differenceOf(mean, gain * even) > kStrange) {
        explainStrange(set, mean, gain);
        return;
    }
    if (hasMoved(picture)) {
        refuseMoved(set);
        return;
    }
    const double first = gains.try_emplace(set.size(), set.size() == 2 ? 1.0 : gain).first->second;
    const double drift = std::abs(gain / first - 1.0);
    if (set.size() == 2) gainNow = gain;
    const std::string why = "is " + percentWords(drift) + (gain > first ? " brighter" : " darker") +
                            " than the first patterns: the exposure drifts";
    const char* const remedy = "switch the camera's automatic exposure off, and let projector and camera warm up";
    if (drift > kDriftRefused) {
        refuse(Cause::exposureDrifts, file(set.back()), why, remedy);
    } else if (drift > kDriftTold && !isDriftTold) {
        warn(Cause::exposureDrifts, file(set.back()), why, remedy);
        isDriftTold = true;
    }
    for (const int image : set) lookAtExposure(shot(image), file(image));
    lookAtWay(set);
    if (std::holds_alternative<FlatField>(pattern(set.front()))) {
        const int white = std::get<FlatField>(pattern(set[0])).white ? set[0] : set[1];
        const int black = set[0] + set[1] - white;
        if (cv::mean(thinned(shot(white)) - thinned(shot(black)), lit)[0] < 0.0)
            refuse(Cause::blackWhiteSwapped, file(white), "the image called white is darker than the one called black",
                   "exchange the two images, or correct the order");
    }
}

ShotCheck::ShotCheck(const CaptureOrder& order, std::string name, std::optional<CalibrationBoard> board)
    : data_(std::make_unique<Data>()) {
    data_->order = order;
    data_->name = std::move(name);
    data_->board = std::move(board);
    data_->sets = evenSetsOf(order);
}

ShotCheck::~ShotCheck() = default;
ShotCheck::ShotCheck(ShotCheck&&) noexcept = default;
ShotCheck& ShotCheck::operator=(ShotCheck&&) noexcept = default;

void ShotCheck::lookAtLight(const cv::Mat& white, const cv::Mat& black) {
    if (white.size() != black.size())
        throw InvalidInput("white and black", "have different sizes", "take both with one camera setting");
    cv::Mat1b picture;
    cv::addWeighted(white, 0.5, black, 0.5, 0.0, picture);
    const cv::Mat1f bright = thinned(white);
    const cv::Mat1f dark = thinned(black);
    data_->takeReference(0.5 * (bright + dark), bright - dark, picture);
    if (!data_->findings.refusal) data_->lookAtExposure(white, "");
}

void ShotCheck::look(const cv::Mat& image, const std::string& file) {
    Data& data = *data_;
    const auto index = static_cast<int>(data.images.size());
    data.images.push_back(image);
    data.files.push_back(file);
    if (data.findings.refusal) return;
    const cv::Size before = data.evenLight.empty() ? data.images.front().size() : data.evenLight.size();
    if (image.size() != before) {
        data.refuse(Cause::imageSize, file,
                    "is " + std::to_string(image.cols) + " x " + std::to_string(image.rows) +
                        " pixels, the shots before it " + std::to_string(before.width) + " x " +
                        std::to_string(before.height),
                    "capture this pose again with one camera setting");
        return;
    }
    if (index >= static_cast<int>(data.order.images.size())) {
        data.refuse(Cause::doubledImage, file, "is more than the order has patterns", kTakeAgain);
        return;
    }
    const auto isUnused = [&data](int i) { return std::holds_alternative<UnusedImage>(data.pattern(i)); };
    if (index > 0 && !isUnused(index) && !isUnused(index - 1) &&
        cv::norm(image, data.images[static_cast<std::size_t>(index) - 1], cv::NORM_INF) == 0.0) {
        data.refuse(Cause::doubledImage, file, "is the same image as the one before");
        return;
    }
    for (const std::vector<int>& set : data.sets)
        if (*std::ranges::max_element(set) == index) data.lookAtSet(set);
}

void ShotCheck::finish() {
    Data& data = *data_;
    if (data.findings.refusal) return;
    if (data.images.size() < data.order.images.size()) {
        data.refuse(Cause::missingImage, "",
                    "has " + std::to_string(data.images.size()) + " images, but the patterns are " +
                        std::to_string(data.order.images.size()));
        return;
    }
    const CapturedView view{data.name, {data.files.begin(), data.files.end()}};
    if (auto finding = checkSequence(view, data.images, data.order)) {
        data.findings.refusal = std::move(finding);
        return;
    }
    const DecodedView decoded = decodeView(data.images, data.order);
    if (auto finding = checkProjectorSize(data.name, decoded, data.order.projector, data.onBoard))
        data.findings.refusal = std::move(finding);
    else if (turnOf(decoded) < -0.3)
        data.refuseMirrored("");
}

const ShotFindings& ShotCheck::findings() const noexcept { return data_->findings; }

cv::Mat ShotCheck::evenLight() const { return data_->evenLight; }

std::optional<Finding> checkScaling(const cv::Mat& checkerboard, const cv::Mat& inverse, const cv::Mat& white,
                                    const cv::Mat& black) {
    constexpr double kLost = 0.1; // of the light; noise and a slightly bent response stay below
    cv::Mat1f one, other, bright, dark;
    checkerboard.convertTo(one, CV_32F);
    inverse.convertTo(other, CV_32F);
    white.convertTo(bright, CV_32F);
    black.convertTo(dark, CV_32F);
    const cv::Mat1f change = bright - dark;
    const double level = percentileOf(change, {}, 0.98);
    if (level < kDimSwitched) return std::nullopt;
    cv::Mat1b lit = change > 0.5 * level;
    cv::erode(lit, lit, cv::Mat1b::ones(15, 15)); // edges of shadows and of the picture
    if (cv::countNonZero(lit) * 200 < static_cast<int>(lit.total())) return std::nullopt;
    cv::Mat1f lost, range;
    cv::boxFilter(bright + dark - one - other, lost, CV_32F, {9, 9});
    cv::boxFilter(change, range, CV_32F, {9, 9});
    const cv::Mat1f share = lost / cv::max(range, 1.0);
    const double most = percentileOf(share, lit, 0.9);
    if (most < kLost) return std::nullopt;
    return Finding{Cause::keystone, "", "",
                   "the projector scales or warps its picture: " + percentWords(most) +
                       " of the light of single pixels is lost",
                   "switch keystone, zoom and overscan off in the projector's menu, and set the screen to the "
                   "projector's own resolution"};
}

} // namespace lumorph
