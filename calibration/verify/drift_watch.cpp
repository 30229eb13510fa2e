#include "calibration/verify/drift_watch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>

#include <Eigen/Dense>
#include <opencv2/imgproc.hpp>

#include "calibration/verify/picture_shift.h"
#include "calibration/verify/show_prediction.h"
#include "calibration/verify/silhouette_watch.h"
#include "core/base/error.h"
#include "core/base/statistics.h"

namespace lumorph {

namespace {

constexpr double kSoften = 1.0;       // pixels of blur that both pictures get
constexpr double kWatchFreedom = 3.0; // of Student's distribution
constexpr int kWatchSteps = 6;
constexpr int kFewestCells = 10;
constexpr double kEnoughLooks = 2.0;
constexpr double kMostUnlike = 0.6;   // of the cells with structure
constexpr double kDarkPicture = 10.0; // grey levels that 99 % stay below
constexpr double kSharpEnough = 0.35; // of the contrast between neighbours that was predicted
constexpr double kGainLearns = 0.2;
constexpr std::size_t kFewestGains = 6;
constexpr double kGainSpread = 0.15; // of the median, within which half of the gains of one camera lie
constexpr double kSureSigmas = 4.0;
constexpr double kRivalsFade = 0.7; // a look
constexpr int kFewestSquares = 8;
constexpr double kClearly = 0.85;                                           // of what the worse leaves
constexpr double kAlikeShare = 0.97;                                        // of what the best cause explains
constexpr double kWatchTurn = 0.02, kWatchShift = 0.03, kWatchStroke = 0.2; // nobody believes more

/// Sums over the cells of looks, fading.
struct Evidence {
    Eigen::MatrixXd matrix, beside;
    Eigen::VectorXd vector, seen;
    double looks = 0.0, squares = 0.0, weights = 0.0; ///< of what a robust fit leaves, standard deviations

    explicit Evidence(Eigen::Index size)
        : matrix(Eigen::MatrixXd::Zero(size, size)), beside(matrix), vector(Eigen::VectorXd::Zero(size)), seen(vector) {
    }
    void fade(double share) {
        for (Eigen::MatrixXd* sum : {&matrix, &beside}) *sum *= share;
        for (Eigen::VectorXd* sum : {&vector, &seen}) *sum *= share;
        for (double* sum : {&looks, &squares, &weights}) *sum *= share;
    }
    /// By how much errors are larger than cells say of themselves.
    [[nodiscard]] double excess() const { return std::max(1.0, 0.5 * squares / std::max(1e-9, weights)); }
    void add(const LightEquation& equation, const LitPoint& point, double weight) {
        matrix.noalias() += weight * equation.byMotion.transpose() * point.information * equation.byMotion;
        vector.noalias() -= weight * equation.byMotion.transpose() * (point.information * equation.error);
    }
    /// How far a motion puts beside what was seen: asked for at the end of a fit alone.
    void addBeside(const LightEquation& equation, double weight) {
        const Eigen::MatrixXd spread = equation.beside.transpose() * equation.beside;
        beside += weight * spread;
        seen += weight * spread.diagonal().unaryExpr([](double s) { return s > 1e-6 ? 1.0 : 0.0; });
    }
};

/// A cause, fitted alone.
struct Explanation {
    RoomPart part;
    double explained = 0.0, beside = 0.0, sigma = 0.0;
    Eigen::VectorXd motion{}; ///< of all parts, where only this one moved
};

/// Two causes that move light alike, and what each leaves of outlines and folds: sums that fade.
struct Rivals {
    RoomPart first, second;
    double leftOfFirst = 0.0, leftOfSecond = 0.0;
    int squares = 0;
    [[nodiscard]] bool areThese(const RoomPart& a, const RoomPart& b) const {
        return (first == a && second == b) || (first == b && second == a);
    }
};

/// Whether the cells tell a cause from the likeliest.
bool areAlike(const std::vector<Explanation>& explanations, std::size_t other) {
    return other < explanations.size() && explanations[other].explained >= kAlikeShare * explanations.front().explained;
}

/// The gain that measured cells agree on. Content that looks alike by chance has any; 0 then.
double commonGain(const std::vector<CellShift>& shifts) {
    std::vector<double> gains;
    for (const CellShift& shift : shifts)
        if (shift.kind == CellShift::Kind::measured) gains.push_back(shift.gain);
    if (gains.size() < kFewestGains) return 0.0;
    const double usual = median(gains);
    for (double& gain : gains) gain = std::abs(gain - usual);
    return median(std::move(gains)) < kGainSpread * usual ? usual : 0.0;
}

std::string besideWords(double metres) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f mm", 1e3 * metres);
    return text;
}

} // namespace

struct DriftWatch::Data {
    Data(const Rig& rig, const Installation& believed, const DriftWatchOptions& wish)
        : options(wish), prediction(rig, believed, wish.width, wish.camera), parts(partsOf(believed, rig)),
          evidence(parts.size()), silhouettes(rig, believed, wish.width, wish.camera, wish.memory) {}

    DriftWatchOptions options;
    ShowPrediction prediction;
    RoomParts parts;
    Evidence evidence;
    SilhouetteWatch silhouettes;
    std::vector<WatchCell> cells;
    std::shared_ptr<const RoomSurface> cellsOfRays; ///< of which they are
    double gain = 0.0;                              ///< grey levels a unit of light, as looks had it
    Rivals rivals;
    std::optional<double> lastLook, movedSince;
    DriftReport report;

    /// Equations of one look, or why there are none.
    struct Glance {
        std::vector<std::pair<LightEquation, LitPoint>> equations;
        std::optional<NoVerdict> obstacle;
        CoarseShow sent;
        cv::Mat1f seen; ///< blurred
    };
    Glance glance(const ShowLook& show, const Progress& progress);
    [[nodiscard]] std::optional<NoVerdict> obstacleOf(const cv::Mat1f& seen, const cv::Mat1f& predicted, int unlike,
                                                      int alike) const;
    [[nodiscard]] std::vector<CellShift> shiftsOf(const cv::Mat1f& predicted, const cv::Mat1f& seen,
                                                  const Progress& progress) const;
    void learnGain(std::vector<double> gains);
    void gather(const Glance& glance);
    [[nodiscard]] Eigen::MatrixXd known(const Eigen::MatrixXd& matrix) const;
    [[nodiscard]] Explanation explain(const RoomPart& part) const;
    void judge(const ShowLook& show, const Glance& glance);
    [[nodiscard]] std::optional<Explanation> deviceAlone(const Explanation& likeliest) const;
    void judgeRivals(std::vector<Explanation>& explanations, const ShowLook& show, const Glance& glance);
    void say(const std::vector<Explanation>& explanations, double now);
};

std::optional<NoVerdict> DriftWatch::Data::obstacleOf(const cv::Mat1f& seen, const cv::Mat1f& predicted, int unlike,
                                                      int alike) const {
    if (alike + unlike < kFewestCells)
        return NoVerdict{Obstacle::noLight, "the show has too little structure to be compared just now",
                         "wait for other content, or check with patterns"};
    std::vector<float> greys(seen.begin(), seen.end());
    const auto bright = greys.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(greys.size() - 1));
    std::ranges::nth_element(greys, bright);
    if (static_cast<double>(*bright) < kDarkPicture)
        return NoVerdict{Obstacle::tooDark, "the camera sees nothing",
                         "take the cap off its lens, or expose it longer"};
    if (static_cast<double>(unlike) < kMostUnlike * (alike + unlike)) return std::nullopt;
    const auto roughness = [](const cv::Mat1f& picture) {
        cv::Mat1f across;
        cv::Scalar mean, spread;
        cv::Laplacian(picture, across, CV_32F);
        cv::meanStdDev(across, mean, spread);
        const double fine = spread[0];
        cv::meanStdDev(picture, mean, spread);
        return fine / std::max(1e-6, spread[0]);
    };
    if (roughness(seen) < kSharpEnough * roughness(predicted))
        return NoVerdict{Obstacle::blurred, "the camera's picture is blurred", "focus it, and clean its lens"};
    return NoVerdict{Obstacle::covered, "most of what the camera sees is not what is shown",
                     "look whether something stands in its sight; else check the room with patterns"};
}

DriftWatch::Data::Glance DriftWatch::Data::glance(const ShowLook& show, const Progress& progress) {
    Glance glance;
    glance.sent = prediction.coarse(show.sent, show.strokes);
    progress.throwIfCancelled();
    cv::Mat1f predicted = prediction.predict(glance.sent, show.strokes), seen;
    progress.throwIfCancelled();
    if (show.photograph.empty()) {
        glance.obstacle =
            NoVerdict{Obstacle::cameraLost, "the camera gives no picture", "look whether it is plugged in"};
        return glance;
    }
    try {
        seen = prediction.shrink(show.photograph);
    } catch (const InvalidInput& wrong) {
        glance.obstacle = NoVerdict{
            Obstacle::cameraLost, "the camera's picture has another shape than it was calibrated with", wrong.remedy()};
        return glance;
    }
    const cv::Mat1f sharp = predicted.clone(), sharpSeen = seen.clone();
    for (cv::Mat1f* picture : {&predicted, &seen}) cv::GaussianBlur(*picture, *picture, {}, kSoften);
    glance.seen = seen;
    const ShowSight& sight = prediction.sight(show.strokes);
    if (sight.rays != cellsOfRays) {
        cells = cellsOf(sight);
        cellsOfRays = sight.rays;
    }
    const LightModel model(prediction.room(), parts, options.camera);
    int unlike = 0;
    std::vector<double> gains;
    const std::vector<CellShift> shifts = shiftsOf(predicted, seen, progress);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const WatchCell& cell = cells[i];
        const CellShift& shift = shifts[i];
        unlike += shift.kind == CellShift::Kind::unlike ? 1 : 0;
        if (shift.kind != CellShift::Kind::measured) continue;
        gains.push_back(shift.gain);
        LitPoint point{cell.projector,
                       {cell.middle.x + shift.shift.x(), cell.middle.y + shift.shift.y()},
                       {cell.panel.x(), cell.panel.y()}};
        const Eigen::Matrix2d pixelByPanel = cell.panelByPixel.inverse();
        point.information = pixelByPanel.transpose() * shift.information * pixelByPanel;
        if (auto equation = model.equation(*sight.rays, point)) glance.equations.emplace_back(*equation, point);
    }
    glance.obstacle = obstacleOf(seen, predicted, unlike, static_cast<int>(glance.equations.size()));
    if (glance.obstacle) return glance;
    learnGain(std::move(gains));
    progress.throwIfCancelled();
    silhouettes.look(show.seconds, glance.sent, show.strokes, sharp, sharpSeen, gain);
    return glance;
}

/// Of all cells. At first no gain is known, and noise over faint content is no other content: the cells that are alike
/// tell which content is faint. Where too few do, everything counts.
std::vector<CellShift> DriftWatch::Data::shiftsOf(const cv::Mat1f& predicted, const cv::Mat1f& seen,
                                                  const Progress& progress) const {
    const auto by = [&](double usual) {
        std::vector<CellShift> shifts;
        for (const WatchCell& cell : cells) {
            progress.throwIfCancelled();
            shifts.push_back(shiftOf(predicted, seen, cell.place, usual));
        }
        return shifts;
    };
    std::vector<CellShift> shifts = by(gain);
    if (gain > 0.0) return shifts;
    const double common = commonGain(shifts);
    if (!(common > 0.0)) return shifts;
    std::vector<CellShift> clear = by(common);
    const auto told =
        std::ranges::count_if(clear, [](const CellShift& one) { return one.kind != CellShift::Kind::empty; });
    return told < kFewestCells ? shifts : clear;
}

void DriftWatch::Data::learnGain(std::vector<double> gains) {
    const auto middle = gains.begin() + static_cast<std::ptrdiff_t>(gains.size() / 2);
    std::ranges::nth_element(gains, middle);
    gain = gain > 0.0 ? gain + kGainLearns * (*middle - gain) : *middle;
}

Eigen::MatrixXd DriftWatch::Data::known(const Eigen::MatrixXd& matrix) const {
    Eigen::MatrixXd all = matrix;
    for (const RoomPart& part : parts.all())
        for (Eigen::Index i = 0; i < part.count; ++i) {
            const double sigma = part.kind == RoomPart::Kind::servo ? kWatchStroke : i < 3 ? kWatchTurn : kWatchShift;
            all(part.first + i, part.first + i) += 1.0 / (sigma * sigma);
        }
    return all;
}

/// Adds a look, each cell with the weight that a robust fit of everything at once gives it.
void DriftWatch::Data::gather(const Glance& glance) {
    Eigen::VectorXd motion = Eigen::VectorXd::Zero(parts.size());
    for (int step = 0;; ++step) {
        Evidence sums(parts.size());
        for (const auto& [equation, point] : glance.equations) {
            const Eigen::Vector2d left = equation.error + equation.byMotion * motion;
            const double squared = left.dot(point.information * left);
            const double weight = (kWatchFreedom + 2.0) / (kWatchFreedom + squared);
            sums.add(equation, point, weight);
            if (step == kWatchSteps) sums.addBeside(equation, weight);
            sums.squares += weight * squared;
            sums.weights += weight;
        }
        if (step < kWatchSteps) {
            motion = known(sums.matrix).ldlt().solve(sums.vector);
            continue;
        }
        evidence.matrix += sums.matrix;
        evidence.beside += sums.beside;
        evidence.vector += sums.vector;
        evidence.seen += sums.seen;
        evidence.squares += sums.squares;
        evidence.weights += sums.weights;
        evidence.looks += 1.0;
        return;
    }
}

/// Looks repeat one another's errors: together they count as one.
Explanation DriftWatch::Data::explain(const RoomPart& part) const {
    const auto block = [&](const Eigen::MatrixXd& of) {
        return Eigen::MatrixXd(of.block(part.first, part.first, part.count, part.count));
    };
    const double share = 1.0 / (std::max(1e-9, evidence.looks) * evidence.excess());
    const Eigen::MatrixXd covariance = block(known(share * evidence.matrix)).inverse();
    const Eigen::VectorXd vector = share * evidence.vector.segment(part.first, part.count);
    const Eigen::VectorXd motion = covariance * vector;
    const double seen = std::max(1e-9, evidence.seen.segment(part.first, part.count).maxCoeff());
    const Eigen::MatrixXd mean = block(evidence.beside) / seen;
    Eigen::VectorXd all = Eigen::VectorXd::Zero(parts.size());
    all.segment(part.first, part.count) = motion;
    return {part, vector.dot(motion), std::sqrt(std::max(0.0, motion.dot(mean * motion))),
            std::sqrt(std::max(0.0, (mean * covariance).trace())), all};
}

void DriftWatch::Data::judge(const ShowLook& show, const Glance& glance) {
    report.cells = static_cast<int>(glance.equations.size());
    std::vector<Explanation> explanations;
    // Of the device the outline tells; a flap fills too few cells to tell of its servo, which is the check's.
    for (const RoomPart& part : parts.all())
        if (part.kind == RoomPart::Kind::projector || part.kind == RoomPart::Kind::camera)
            explanations.push_back(explain(part));
    std::ranges::sort(explanations, std::greater{}, &Explanation::explained);
    const bool isEnough = evidence.looks >= kEnoughLooks;
    const auto lamp = std::ranges::find(explanations, RoomPart::Kind::projector,
                                        [](const Explanation& one) { return one.part.kind; });
    const bool isBlind = glance.obstacle || (isEnough && lamp->sigma > options.blindFrom);
    if (!isBlind && isEnough) {
        if (const auto device = deviceAlone(explanations.front()))
            explanations = {*device};
        else
            judgeRivals(explanations, show, glance);
        return say(explanations, show.seconds);
    }
    movedSince = report.state == DriftReport::State::moved ? movedSince : std::nullopt;
    report.obstacle = glance.obstacle;
    report.state = isBlind ? DriftReport::State::blind : DriftReport::State::watching;
    if (isBlind && !report.obstacle)
        report.obstacle = NoVerdict{Obstacle::noLight, "the show has too little structure to be compared just now",
                                    "wait for other content, or check with patterns"};
    report.sentence = isBlind ? "The watch cannot tell: " + sentenceOf(*report.obstacle) : "Watching.";
}

/// As long as projector and camera are where they were, what moved at the outline is the device.
std::optional<Explanation> DriftWatch::Data::deviceAlone(const Explanation& likeliest) const {
    const SilhouetteWatch::Result outline = silhouettes.result();
    const bool isSure = outline.looks >= kEnoughLooks && outline.beside > kSureSigmas * outline.sigma;
    if (!isSure || likeliest.beside > 0.5 * options.alarm || outline.beside < likeliest.beside) return std::nullopt;
    return Explanation{parts.device(), 0.0, outline.beside, outline.sigma};
}

/// On a plane a projector and a camera that moved make the same picture; where the device is in it they do not: light
/// moves over an outline that stays, or the outline moves as well. Of the likeliest two the one that predicts it
/// worse is taken away, as soon as that is clear.
void DriftWatch::Data::judgeRivals(std::vector<Explanation>& explanations, const ShowLook& show, const Glance& glance) {
    if (explanations.front().beside < options.alarm || !areAlike(explanations, 1)) return;
    const Explanation &first = explanations[0], &second = explanations[1];
    if (!rivals.areThese(first.part, second.part)) rivals = {first.part, second.part};
    const auto predicted = [&](const RoomPart& part) {
        const Explanation& by = first.part == part ? first : second;
        const Installation room = movedBy(prediction.room(), parts, by.motion, options.camera);
        cv::Mat1f picture =
            ShowPrediction(prediction.rig(), room, options.width, options.camera).predict(glance.sent, show.strokes);
        cv::GaussianBlur(picture, picture, {}, kSoften);
        return picture;
    };
    const Rivalry told = rivalryOf(predicted(rivals.first), predicted(rivals.second), glance.seen, gain);
    rivals.leftOfFirst = kRivalsFade * rivals.leftOfFirst + told.first;
    rivals.leftOfSecond = kRivalsFade * rivals.leftOfSecond + told.second;
    rivals.squares += told.squares;
    const double more = std::max(rivals.leftOfFirst, rivals.leftOfSecond);
    const double less = std::min(rivals.leftOfFirst, rivals.leftOfSecond);
    if (rivals.squares < kFewestSquares || less > kClearly * more) return;
    const RoomPart worse = rivals.leftOfFirst > rivals.leftOfSecond ? rivals.first : rivals.second;
    explanations.erase(explanations.begin() + (worse == first.part ? 0 : 1));
}

void DriftWatch::Data::say(const std::vector<Explanation>& explanations, double now) {
    const Explanation& best = explanations.front();
    report.obstacle.reset();
    report.part = nameOf(best.part, prediction.room(), prediction.rig());
    report.beside = best.beside;
    report.sigma = best.sigma;
    report.couldAlsoBe.clear();
    const bool isFar = best.beside > options.alarm && best.beside > kSureSigmas * best.sigma;
    if (!isFar) movedSince.reset();
    if (isFar && !movedSince) movedSince = now;
    report.state =
        movedSince && now - *movedSince >= options.patience ? DriftReport::State::moved : DriftReport::State::good;
    if (report.state == DriftReport::State::good) {
        report.sentence = "The light lies where it belongs.";
        return;
    }
    std::string any = report.part;
    for (std::size_t i = 1; i < explanations.size(); ++i) {
        if (!areAlike(explanations, i)) continue;
        report.couldAlsoBe.push_back(nameOf(explanations[i].part, prediction.room(), prediction.rig()));
        any += " or the " + report.couldAlsoBe.back();
    }
    report.sentence =
        "The " + any + " has moved by about " + besideWords(best.beside) + ": check the room when nobody is there.";
}

DriftWatch::DriftWatch(const Rig& rig, const Installation& believed, const DriftWatchOptions& options)
    : data_(std::make_unique<Data>(rig, believed, options)) {}
DriftWatch::~DriftWatch() = default;
DriftWatch::DriftWatch(DriftWatch&&) noexcept = default;
DriftWatch& DriftWatch::operator=(DriftWatch&&) noexcept = default;

const DriftReport& DriftWatch::report() const noexcept { return data_->report; }

const DriftReport& DriftWatch::look(const ShowLook& show, const Progress& progress) {
    const Data::Glance glance = data_->glance(show, progress);
    progress.throwIfCancelled();
    if (data_->lastLook)
        data_->evidence.fade(std::exp(-std::max(0.0, show.seconds - *data_->lastLook) / data_->options.memory));
    data_->lastLook = show.seconds;
    data_->silhouettes.fadeTo(show.seconds);
    if (!glance.obstacle) data_->gather(glance);
    progress.throwIfCancelled();
    data_->judge(show, glance);
    return data_->report;
}

} // namespace lumorph
