#include "app/table/table_camera.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <thread>

#include <opencv2/imgproc.hpp>

#include "calibration/lab/board_texture.h"
#include "calibration/lab/lab_photograph.h"
#include "calibration/lab/lab_world.h"
#include "core/loop/pose_stream.h"

namespace lumorph::table {

namespace {

constexpr double kStill = 0.002;        // of a stroke: less is not worth new rays
constexpr double kStillPlace = 1e-5;    // metres
constexpr double kStillTurn = 1e-5;     // of a quaternion's part
constexpr double kLift = 2e-5;          // metres of the paper above the table, and of the ink above the paper
constexpr double kUnit = 1e-3;          // metres, of a board's lengths
constexpr int kCircleCells = 40;        // of a spacing: each is all paper or all ink
constexpr double kAutomaticGrey = 90.0; // mean of a picture to which an automatic exposure goes
constexpr double kAutomaticPace = 0.3;  // of the way, a picture
constexpr double kAutomaticReach = 8.0; // times brighter or darker
constexpr glm::vec3 kNight{1.0F, 0.72F, 0.45F};
constexpr glm::vec3 kInk{0.08F};
constexpr glm::vec3 kPaper{0.85F};

bool isStill(const Standing& a, const Standing& b) {
    const auto differs = [](double s, double t) { return std::abs(s - t) > kStill; };
    const glm::dquat turn = a.device.rotation - b.device.rotation;
    return a.worldFromBoard == b.worldFromBoard && a.hand == b.hand && a.strokes.size() == b.strokes.size() &&
           std::ranges::equal(a.strokes, b.strokes, std::not_fn(differs)) &&
           glm::distance(a.device.position, b.device.position) < kStillPlace &&
           std::max({std::abs(turn.x), std::abs(turn.y), std::abs(turn.z), std::abs(turn.w)}) < kStillTurn;
}

/// Two triangles; seen from both sides.
void addCell(TriangleMesh& mesh, const glm::dmat4& worldFromBoard, const cv::Rect2d& cell, double z) {
    const auto at = [&](double x, double y) {
        return glm::vec3(worldFromBoard * glm::dvec4(kUnit * x, kUnit * y, z, 1.0));
    };
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const double x = cell.x, y = cell.y, right = cell.x + cell.width, low = cell.y + cell.height;
    for (const glm::vec3& corner : {at(x, y), at(x, low), at(right, low), at(right, y)})
        mesh.positions.push_back(corner);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
}

/// The sheet of a board, and its ink as a second surface on the printed side.
void addBoard(LabWorld& world, const CalibrationBoard& board, const glm::dmat4& worldFromBoard) {
    const BoardTexture texture(board);
    LabSurface paper{{}, kPaper}, ink{{}, kInk};
    // A board that lies flat is in the table's plane: rays would find now the one, now the other.
    constexpr double kUp = BoardTexture::printedSide() * kLift;
    addCell(paper.mesh, worldFromBoard, texture.page(), kUp);
    const bool isRound = board.kind == CalibrationBoard::Kind::circles;
    const double cell =
        board.kind == CalibrationBoard::Kind::charuco ? 0.0 : board.spacing / (isRound ? kCircleCells : 1);
    // Cells of ChArUco: the edges of squares and of markers' cells, which do not divide each other.
    std::vector<double> xs, ys;
    const cv::Rect2d page = texture.page();
    if (cell > 0.0) {
        const double from = -2.0 * board.spacing;
        for (double x = from; x < page.x + page.width; x += cell) xs.push_back(x);
        for (double y = from; y < page.y + page.height; y += cell) ys.push_back(y);
    } else {
        const double edge = 0.5 * (board.spacing - board.marker);
        const int cells = texture.markerCells();
        const auto add = [&](std::vector<double>& to, int squares) {
            for (int square = 0; square <= squares; ++square) {
                to.push_back(board.spacing * square);
                if (square == squares) continue;
                for (int k = 0; k <= cells; ++k) to.push_back(board.spacing * square + edge + board.marker * k / cells);
            }
        };
        add(xs, board.columns);
        add(ys, board.rows);
    }
    for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
        std::size_t begin = xs.size(); // of a run of ink; that: of none
        for (std::size_t i = 0; i < xs.size(); ++i) {
            const bool isInk = i + 1 < xs.size() && page.contains(cv::Point2d(xs[i], ys[j])) &&
                               texture.albedo(0.5 * (xs[i] + xs[i + 1]), 0.5 * (ys[j] + ys[j + 1])) < 0.5F;
            if (isInk) begin = std::min(begin, i);
            if (isInk || begin == xs.size()) continue;
            addCell(ink.mesh, worldFromBoard, {xs[begin], ys[j], xs[i] - xs[begin], ys[j + 1] - ys[j]}, 2.0 * kUp);
            begin = xs.size();
        }
    }
    world.surfaces.push_back(std::move(paper));
    world.surfaces.push_back(std::move(ink));
}

/// Noise of a standard deviation of 1, from which each picture takes another part.
cv::Mat1f noiseTile(cv::Size size, std::uint32_t seed) {
    cv::Mat1f tile(2 * size.height, 2 * size.width);
    cv::RNG dice(seed);
    dice.fill(tile, cv::RNG::NORMAL, 0.0, 1.0);
    return tile;
}

cv::Mat1f vignette(cv::Size size, double share) {
    cv::Mat1f light(size);
    const double radius = std::hypot(0.5 * size.width, 0.5 * size.height);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const double r = std::hypot(x - 0.5 * size.width, y - 0.5 * size.height) / radius;
            light(y, x) = static_cast<float>(1.0 - share * r * r);
        }
    return light;
}

Image atNight(const Image& picture) {
    Image warm = picture;
    for (Image::Pixel& pixel : warm.pixels())
        for (int channel = 0; channel < 3; ++channel)
            pixel[channel] = static_cast<std::uint8_t>(std::lround(kNight[channel] * pixel[channel]));
    return warm;
}

} // namespace

struct TableCamera::Data {
    const Table& table;
    const ScreenEye& eye;
    CalibratedCamera camera;
    TableCameraOptions options;
    CalibrationBoard board;
    SteadyClock clock;
    std::mutex mutex;
    Standing stood;
    std::unique_ptr<Lab> lab;
    LabSight sight;                                   ///< with one ray a pixel while something moves
    std::shared_ptr<const Image> none;                ///< of a projector whose lens is covered
    std::vector<std::shared_ptr<const Image>> thrown; ///< by the lab's projectors now
    double levels = 1.0;                              ///< grey of radiance 1 in the usual time
    Microseconds working{0};                          ///< that a picture takes to be worked out
    cv::Mat1f noise, corners;
    std::mt19937 dice;
    bool setsExposure = false, seesNightLight = false;
    double automatic = 1.0; ///< what its own exposure makes of the light

    void stand(const Standing& now);
    [[nodiscard]] cv::Size size() const { return {camera.size.x, camera.size.y}; }
};

/// New rays for what stands there now.
void TableCamera::Data::stand(const Standing& now) {
    const TableTruth& truth = table.truth();
    Installation room = truth.room;
    room.worldFromDevice = glm::mat4(matrixOf(now.device));
    LabWorld world = roomWorld(room, *truth.rig, now.strokes);
    if (now.worldFromBoard) {
        world.surfaces.front().mesh = {}; // whoever lays a board there has put the device aside
        addBoard(world, board, *now.worldFromBoard);
    }
    if (now.hand) world.blockers.push_back(visitorHand(glm::vec3(*now.hand), room.eye));
    double peak = 0.0;
    for (const InstalledProjector& projector : room.projectors) {
        peak = std::max(peak, projector.peak);
        world.projectors.push_back({projector, Image(projector.camera.size)});
    }
    world.ambient = glm::vec3(static_cast<float>(options.ambient * peak));
    lab = std::make_unique<Lab>(std::move(world));
    sight = lab->look(camera, 1);
    thrown.assign(room.projectors.size(), nullptr);
    stood = now;
}

TableCamera::TableCamera(const Table& table, const ScreenEye& eye, std::size_t camera,
                         const TableCameraOptions& options)
    : data_(new Data{.table = table,
                     .eye = eye,
                     .camera = table.truth().room.cameras.at(camera).camera,
                     .options = options,
                     .board = parseCalibrationBoard(table.truth().board),
                     .clock = {},
                     .mutex = {},
                     .stood = {},
                     .lab = {},
                     .sight = {},
                     .none = std::make_shared<const Image>(),
                     .thrown = {},
                     .noise = {},
                     .corners = {},
                     .dice = std::mt19937(table.truth().seed + 31U * static_cast<std::uint32_t>(camera))}) {
    data_->noise = noiseTile(data_->size(), table.truth().seed + static_cast<std::uint32_t>(camera));
    data_->corners = vignette(data_->size(), options.vignetting);
    data_->stand(table.at(data_->clock.now()));
    data_->levels = exposureOf(*data_->lab, data_->sight, options.white, "camera of the table");
    data_->thrown.assign(data_->thrown.size(), nullptr); // they were made white
}

TableCamera::~TableCamera() = default;

cv::Size TableCamera::size() const { return data_->size(); }

void TableCamera::setSetsExposure(bool does) {
    const std::lock_guard lock(data_->mutex);
    data_->setsExposure = does;
    data_->automatic = 1.0;
}

void TableCamera::setSeesNightLight(bool does) {
    const std::lock_guard lock(data_->mutex);
    data_->seesNightLight = does;
    data_->thrown.assign(data_->thrown.size(), nullptr); // to be shown anew
}

cv::Mat1b TableCamera::photograph(double exposureSeconds, double gainDecibels) {
    Data& data = *data_;
    std::unique_lock lock(data.mutex);
    const Microseconds late(std::llround(1e6 * data.table.truth().room.predictionSeconds));
    // New rays first, which take longer than a picture: time goes on meanwhile.
    const Standing now = data.table.at(data.clock.now());
    if (!isStill(now, data.stood))
        data.stand(now);
    else if (data.sight.samples == 1)
        data.sight = data.lab->finer(data.camera, data.sight);
    // The light of when it will be ready: whoever gets it takes its exposure to have ended just before it came. What
    // the screens show then need not be known yet, as its light comes late.
    const Microseconds begun = data.clock.now(), ready = begun + data.working;
    const Microseconds middle = ready - Microseconds(std::llround(0.5e6 * exposureSeconds));
    const Microseconds shown = middle - late;
    for (std::size_t k = 0; k < data.thrown.size(); ++k) {
        auto picture = now.isCovered ? data.none : data.eye.at(k, shown).picture;
        if (picture == data.thrown[k]) continue;
        data.lab->show(k, data.seesNightLight ? atNight(*picture) : *picture);
        data.thrown[k] = std::move(picture);
    }
    cv::Mat1f light = lightIn(*data.lab, data.sight);
    const double grey = data.levels * exposureSeconds / data.options.usualSeconds * std::pow(10.0, gainDecibels / 20.0);
    light = grey * light.mul(data.corners);
    if (data.setsExposure) {
        const double wanted = kAutomaticGrey / std::max(1.0, data.automatic * cv::mean(light)[0]);
        data.automatic =
            std::clamp(data.automatic * std::pow(wanted, kAutomaticPace), 1.0 / kAutomaticReach, kAutomaticReach);
        light *= data.automatic;
    }
    if (data.options.blur > 0.0) cv::GaussianBlur(light, light, {}, data.options.blur);
    const cv::Rect part({static_cast<int>(data.dice() % static_cast<unsigned>(data.size().width)),
                         static_cast<int>(data.dice() % static_cast<unsigned>(data.size().height))},
                        data.size());
    const cv::Mat1f noise = data.noise(part);
    cv::Mat1b picture(data.size());
    const auto dark = static_cast<float>(data.options.noise * data.options.noise);
    const auto shot = static_cast<float>(data.options.shotNoise);
    for (int y = 0; y < light.rows; ++y) {
        const float* from = light[y];
        const float* dice = noise[y];
        std::uint8_t* to = picture[y];
        for (int x = 0; x < light.cols; ++x)
            to[x] =
                cv::saturate_cast<std::uint8_t>(from[x] + dice[x] * std::sqrt(dark + shot * std::max(0.0F, from[x])));
    }
    // The longest of late.
    const Microseconds took = data.clock.now() - begun;
    data.working = std::min(late, std::max(took, data.working - data.working / 16));
    lock.unlock();
    std::this_thread::sleep_for(ready - begun - took);
    return picture;
}

} // namespace lumorph::table
