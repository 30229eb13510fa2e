#include "calibration/lab/board_lab.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>

#include "calibration/lab/board_texture.h"
#include "calibration/lab/lab_lens.h"
#include "calibration/lab/lab_light.h"
#include "calibration/lab/lab_world.h"
#include "core/base/error.h"
#include "core/geometry/rigid.h"

namespace lumorph {

namespace {

constexpr double kTableBelow = 0.005;  // metres: the board has a thickness, and its face lies at height 0
constexpr double kLeastCosine = 0.5;   // of the angle at which camera and projector see a proposed board
constexpr double kLeastHeight = 0.005; // metres, of a proposed board above the table
constexpr int kTries = 4000;           // of places for one pose
constexpr int kBentFacets = 64;        // of a bent board, along a side
constexpr std::size_t kGrains = 1 << 16;

/// What a ray brings: where in the projector's picture the light comes from, and how much of it.
struct Gleam {
    float column = 0.0F, row = 0.0F;
    float share = 0.0F; ///< grey levels under full white; 0 in shadow
};

/// Bends an image as no radial or tangential distortion does; as large as `amplitude` pixels.
glm::dvec2 waved(const glm::dvec2& pixel, const glm::dvec2& size, double amplitude) {
    if (amplitude == 0.0) return pixel;              // as nearly always, for each ray
    constexpr double kTurn = 3.0 * std::numbers::pi; // over the image
    return pixel +
           amplitude * glm::dvec2(std::sin(kTurn * pixel.y / size.y + 1.0), std::sin(kTurn * pixel.x / size.x + 0.3));
}

glm::dvec2 unwaved(const glm::dvec2& pixel, const glm::dvec2& size, double amplitude) {
    if (amplitude == 0.0) return pixel;
    glm::dvec2 ideal = pixel;
    for (int i = 0; i < 8; ++i) ideal = pixel - (waved(ideal, size, amplitude) - ideal);
    return ideal;
}

/// Normally distributed numbers, made once.
const std::vector<float>& grains() {
    static const std::vector<float> all = [] {
        std::mt19937 random(20);
        std::normal_distribution<float> normal;
        std::vector<float> values(kGrains);
        for (float& value : values) value = normal(random);
        return values;
    }();
    return all;
}

std::uint32_t scrambled(std::uint32_t x) {
    x ^= x << 13U;
    x ^= x >> 17U;
    x ^= x << 5U;
    return x;
}

bool isRigid(const glm::dmat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(matrix[column][row])) return false;
    const glm::dmat3 turn(matrix);
    const glm::dmat3 square = glm::transpose(turn) * turn;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            if (std::abs(square[i][k] - (i == k ? 1.0 : 0.0)) > 1e-6) return false;
    return glm::determinant(turn) > 0.0;
}

void checkOptions(const BoardLabOptions& options) {
    const auto refuse = [](const char* what, const char* remedy) {
        throw InvalidInput("photographer of the lab", what, remedy);
    };
    const double all[] = {options.metresPerUnit, options.whiteLevel,      options.ambient,      options.vignetting,
                          options.blur,          options.noise,           options.shotNoise,    options.tremble,
                          options.shape.across,  options.shape.twist,     options.shape.down,   options.shape.stretch.x,
                          options.cameraWave,    options.shape.stretch.y, options.projectorWave};
    for (const double number : all)
        if (!std::isfinite(number)) refuse("a number of its options is not finite", "give numbers");
    if (!(options.metresPerUnit > 0.0) || !(options.whiteLevel > 0.0) || !(options.shape.stretch.x > 0.0) ||
        !(options.shape.stretch.y > 0.0))
        refuse("a scale is not positive", "give positive numbers");
    if (options.ambient < 0.0 || options.blur < 0.0 || options.noise < 0.0 || options.shotNoise < 0.0 ||
        options.tremble < 0.0)
        refuse("light, blur or noise is negative", "give numbers from 0 on");
    if (options.samples < 1 || options.samples > 8) refuse("its rays a pixel are not 1 to 8 a side", "use 2");
    if (std::abs(cv::determinant(options.warp)) < 1e-9) refuse("its warp cannot be undone", "give a homography");
}

} // namespace

struct BoardLab::Data {
    CalibrationBoard board;
    BoardTexture texture;
    BoardLabOptions options;
    std::uint32_t seed;
    std::mt19937 random;
    InstalledProjector projector;
    CalibratedCamera camera;
    LabLens cameraLens, projectorLens;
    glm::vec2 tableSize{1.0F};
    float tableAlbedo = 1.0F;
    std::optional<glm::dmat4> worldFromBoard;
    std::uint32_t pictures = 0; ///< taken so far

    cv::Mat1f shown;                ///< light of the projector's picture, 0 to 1
    bool isLooked = false;          ///< the two below are of the present world
    std::vector<Gleam> gleams;      ///< samples x samples a camera pixel
    cv::Mat1f even;                 ///< grey levels of the room's light
    std::array<float, 256> light{}; ///< of a value that is shown

    Data(const CalibrationBoard& named, const BoardLabOptions& how, std::uint32_t start)
        : board(named), texture(named), options(how), seed(start), random(start) {}

    [[nodiscard]] double unit() const { return options.metresPerUnit; }
    [[nodiscard]] glm::dvec2 panelSize() const { return projector.camera.size; }

    /// A place on the sheet by its printed coordinates (the board's unit), in the board's frame, metres.
    [[nodiscard]] glm::dvec3 place(double x, double y) const {
        const cv::Rect2d& box = texture.points();
        const double u = (x - box.x) / box.width * 2.0 - 1.0;
        const double v = (y - box.y) / box.height * 2.0 - 1.0;
        const PrintedBoard& shape = options.shape;
        const double height = shape.across * u * u + shape.twist * u * v + shape.down * v * v;
        return unit() * glm::dvec3(shape.stretch.x * x, shape.stretch.y * y, height);
    }

    [[nodiscard]] std::array<glm::dvec3, 4> pageCorners() const {
        const cv::Rect2d& page = texture.page();
        return {place(page.x, page.y), place(page.x + page.width, page.y), place(page.x, page.y + page.height),
                place(page.x + page.width, page.y + page.height)};
    }

    [[nodiscard]] std::optional<glm::dvec2> projectorPixel(const glm::dvec3& point) const;
    [[nodiscard]] TriangleMesh boardMesh() const;
    [[nodiscard]] Lab lab() const;
    void look();
    void lookAlong(const Lab& room, const glm::dvec2& pixel, Gleam& gleam, float& even) const;
    [[nodiscard]] cv::Mat1f exposed() const;
    [[nodiscard]] glm::dmat4 flatPose() const;
    [[nodiscard]] std::optional<glm::dmat4> tiltedPose(int number, std::mt19937& dice) const;
    [[nodiscard]] bool isSeen(const glm::dmat4& worldFromBoard) const;
    /// Grey levels of radiance 1: so that white paper that lies on the table has `whiteLevel`.
    [[nodiscard]] double greyOfRadiance() const;
};

std::optional<glm::dvec2> BoardLab::Data::projectorPixel(const glm::dvec3& point) const {
    const auto ideal = imageOf(projectorLens, point);
    if (!ideal) return std::nullopt;
    const glm::dvec2 panel = waved(*ideal, panelSize(), options.projectorWave);
    const cv::Vec3d shownAt = options.warp.inv() * cv::Vec3d(panel.x, panel.y, 1.0);
    return glm::dvec2(shownAt[0] / shownAt[2], shownAt[1] / shownAt[2]);
}

TriangleMesh BoardLab::Data::boardMesh() const {
    const PrintedBoard& shape = options.shape;
    const bool isFlat = shape.across == 0.0 && shape.twist == 0.0 && shape.down == 0.0;
    const int facets = isFlat ? 1 : kBentFacets;
    const cv::Rect2d& page = texture.page();
    TriangleMesh mesh;
    for (int row = 0; row <= facets; ++row)
        for (int column = 0; column <= facets; ++column) {
            const glm::dvec3 at = place(page.x + page.width * column / facets, page.y + page.height * row / facets);
            mesh.positions.emplace_back(*worldFromBoard * glm::dvec4(at, 1.0));
        }
    const auto index = [facets](int row, int column) {
        return static_cast<std::uint32_t>(row * (facets + 1) + column);
    };
    for (int row = 0; row < facets; ++row)
        for (int column = 0; column < facets; ++column) {
            mesh.triangles.emplace_back(index(row, column), index(row + 1, column), index(row + 1, column + 1));
            mesh.triangles.emplace_back(index(row, column), index(row + 1, column + 1), index(row, column + 1));
        }
    return mesh;
}

Lab BoardLab::Data::lab() const {
    LabWorld world;
    world.surfaces.push_back({tableMesh(tableSize), glm::vec3(tableAlbedo)});
    for (glm::vec3& point : world.surfaces.front().mesh.positions) point.y -= static_cast<float>(kTableBelow);
    if (worldFromBoard) world.surfaces.push_back({boardMesh(), glm::vec3(1.0F)});
    return Lab(std::move(world));
}

double BoardLab::Data::greyOfRadiance() const {
    const glm::dvec3 way = projectorLens.position;
    const double distance = glm::length(way);
    const double reference = projector.referenceDistance / distance;
    const double white = projector.peak * reference * reference * std::max(0.1, way.y / distance);
    constexpr double kPaper = 0.85;
    return options.whiteLevel / (kPaper * white * (1.0 + options.ambient));
}

void BoardLab::Data::lookAlong(const Lab& room, const glm::dvec2& pixel, Gleam& gleam, float& evenLight) const {
    const auto way = rayThrough(cameraLens, unwaved(pixel, camera.size, options.cameraWave));
    if (!way) return;
    const auto hit = room.trace(cameraLens.position, *way);
    if (!hit || hit->surface < 0) return;
    float albedo = tableAlbedo;
    if (hit->surface == 1) {
        const glm::dvec3 at = Rigid(*worldFromBoard).inverse() * hit->point;
        albedo = texture.albedo(at.x / (unit() * options.shape.stretch.x), at.y / (unit() * options.shape.stretch.y));
    }
    const double grey = greyOfRadiance() * static_cast<double>(albedo);
    const glm::dvec3 lamp = projectorLens.position;
    const double away = glm::length(lamp);
    const double white = projector.peak * std::pow(projector.referenceDistance / away, 2.0);
    evenLight += static_cast<float>(grey * white * options.ambient);
    const auto shownAt = projectorPixel(hit->point);
    if (!shownAt || !inImage(projectorLens, *shownAt) || !room.sees(hit->point, hit->normal, lamp)) return;
    const glm::dvec3 toLamp = lamp - hit->point;
    const double distance = glm::length(toLamp);
    const double reference = projector.referenceDistance / distance;
    const double strength =
        projector.peak * reference * reference * std::max(0.0, glm::dot(toLamp, hit->normal)) / distance;
    gleam = {static_cast<float>(shownAt->x), static_cast<float>(shownAt->y), static_cast<float>(grey * strength)};
}

void BoardLab::Data::look() {
    if (isLooked) return;
    const Lab room = lab();
    const int samples = options.samples;
    const auto each = static_cast<std::size_t>(samples) * static_cast<std::size_t>(samples);
    const auto width = static_cast<std::size_t>(camera.size.x);
    gleams.assign(each * width * static_cast<std::size_t>(camera.size.y), {});
    even = cv::Mat1f::zeros(camera.size.y, camera.size.x);
    const glm::dvec2 middle = 0.5 * glm::dvec2(camera.size - 1);
    const float share = 1.0F / static_cast<float>(each);
    tbb::parallel_for(0, camera.size.y, [&](int y) {
        for (int x = 0; x < camera.size.x; ++x) {
            const glm::dvec2 off = (glm::dvec2(x, y) - middle) / glm::length(middle);
            const float kept = static_cast<float>(1.0 - options.vignetting * glm::dot(off, off)) * share;
            const std::size_t first = each * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x));
            for (int sample = 0; sample < samples * samples; ++sample) {
                const glm::dvec2 within((sample % samples + 0.5) / samples - 0.5,
                                        (sample / samples + 0.5) / samples - 0.5); // NOLINT(bugprone-integer-division)
                Gleam& gleam = gleams[first + static_cast<std::size_t>(sample)];
                lookAlong(room, glm::dvec2(x, y) + within, gleam, even(y, x));
                gleam.share *= kept;
            }
            even(y, x) *= kept;
        }
    });
    isLooked = true;
}

cv::Mat1f BoardLab::Data::exposed() const {
    cv::Mat1f grey = even.clone();
    const auto each = static_cast<std::size_t>(options.samples) * static_cast<std::size_t>(options.samples);
    const auto width = static_cast<std::size_t>(grey.cols);
    const auto lastColumn = static_cast<float>(shown.cols - 1);
    const auto lastRow = static_cast<float>(shown.rows - 1);
    tbb::parallel_for(0, grey.rows, [&](int y) {
        const Gleam* gleam = &gleams[each * width * static_cast<std::size_t>(y)];
        for (int x = 0; x < grey.cols; ++x) {
            float sum = 0.0F;
            for (std::size_t i = 0; i < each; ++i, ++gleam) {
                if (gleam->share == 0.0F) continue;
                const float column = std::clamp(gleam->column, 0.0F, lastColumn);
                const float row = std::clamp(gleam->row, 0.0F, lastRow);
                const int left = std::min(static_cast<int>(column), std::max(0, shown.cols - 2));
                const int top = std::min(static_cast<int>(row), std::max(0, shown.rows - 2));
                const float across = column - static_cast<float>(left);
                const float down = row - static_cast<float>(top);
                const float* upper = shown[top] + left;
                const float* lower = shown[top + 1] + left;
                const float above = upper[0] + across * (upper[1] - upper[0]);
                const float below = lower[0] + across * (lower[1] - lower[0]);
                sum += gleam->share * (above + down * (below - above));
            }
            grey(y, x) += sum;
        }
    });
    return grey;
}

glm::dmat4 BoardLab::Data::flatPose() const {
    // The printed side up: y towards the viewer where it is that of -z, else away from him.
    glm::dmat4 pose(1.0);
    const double side = texture.printedSide();
    pose[0] = {1.0, 0.0, 0.0, 0.0};
    pose[1] = {0.0, 0.0, -side, 0.0};
    pose[2] = {0.0, side, 0.0, 0.0};
    const cv::Rect2d& box = texture.points();
    const glm::dvec3 middle(unit() * (box.x + 0.5 * box.width), unit() * (box.y + 0.5 * box.height), 0.0);
    return glm::translate(pose, -middle);
}

bool BoardLab::Data::isSeen(const glm::dmat4& pose) const {
    const glm::dvec3 printed = static_cast<double>(texture.printedSide()) * glm::dvec3(pose[2]);
    for (const glm::dvec3& corner : pageCorners()) {
        const glm::dvec3 at(pose * glm::dvec4(corner, 1.0));
        for (const LabLens* lens : {&cameraLens, &projectorLens}) {
            const auto pixel = imageOf(*lens, at);
            const glm::dvec2 room = 0.02 * glm::dvec2(lens->size);
            if (!pixel || pixel->x < room.x || pixel->y < room.y || pixel->x > lens->size.x - 1 - room.x ||
                pixel->y > lens->size.y - 1 - room.y)
                return false;
            if (glm::dot(glm::normalize(lens->position - at), printed) < kLeastCosine) return false;
        }
    }
    return true;
}

std::optional<glm::dmat4> BoardLab::Data::tiltedPose(int number, std::mt19937& dice) const {
    const glm::dmat4 flat = flatPose();
    const auto between = [&dice](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(dice);
    };
    constexpr double kGolden = 2.399963229728653; // radians: neighbours in the list tilt to different sides
    const double side = kGolden * number + between(0.0, 2.0 * std::numbers::pi / 8.0);
    for (int i = 0; i < kTries; ++i) {
        const double reach = 0.5 * std::min(tableSize.x, tableSize.y);
        // Later tries stay nearer to the middle and tilt less.
        const double ease = 1.0 - 0.8 * i / kTries;
        const double tilt = glm::radians(15.0 + 25.0 * ease * between(0.2, 1.0));
        const double towards = side + between(-0.3, 0.3) * (2.0 - ease);
        const double turn = glm::radians(between(-25.0, 25.0));
        const glm::dvec3 place(ease * reach * between(-0.6, 0.6), 0.02 + ease * between(0.0, 0.35),
                               ease * reach * between(-0.6, 0.6));
        const glm::dmat4 tilted = glm::rotate(glm::translate(glm::dmat4(1.0), place), tilt,
                                              glm::dvec3(std::cos(towards), 0.0, std::sin(towards))) *
                                  glm::rotate(glm::dmat4(1.0), turn, glm::dvec3(0.0, 1.0, 0.0));
        glm::dmat4 pose = tilted * flat;
        double lowest = 1e9;
        for (const glm::dvec3& corner : pageCorners()) lowest = std::min(lowest, (pose * glm::dvec4(corner, 1.0)).y);
        if (lowest < kLeastHeight) pose[3].y += kLeastHeight - lowest;
        if (isSeen(pose)) return pose;
    }
    return std::nullopt;
}

BoardLab::BoardLab(const Installation& truth, const CalibrationBoard& board, const BoardLabOptions& options,
                   std::uint32_t seed) {
    checkOptions(options);
    if (truth.projectors.empty())
        throw InvalidInput("virtual lab", "its installation has no projector", "add one, or use the default lab");
    data_ = std::make_unique<Data>(board, options, seed);
    data_->projector = truth.projectors.front();
    data_->tableSize = truth.tableSize;
    const glm::vec3 color = lightOfSrgb(truth.tableColor);
    data_->tableAlbedo = (color.r + color.g + color.b) / 3.0F;
    for (std::size_t i = 0; i < data_->light.size(); ++i) {
        const double value = static_cast<double>(i) / 255.0;
        const double gamma = data_->projector.gamma;
        data_->light[i] = static_cast<float>(gamma == 0.0 ? lightOfSrgb(value) : std::pow(value, gamma));
    }
    data_->projectorLens = lensOf(data_->projector.camera, "projector of the lab");
    data_->shown = cv::Mat1f::zeros(data_->projector.camera.size.y, data_->projector.camera.size.x);
    setCamera(truth.cameras.empty() ? defaultLabCamera(data_->projector.camera) : truth.cameras.front().camera);
}

BoardLab::~BoardLab() = default;
BoardLab::BoardLab(BoardLab&&) noexcept = default;
BoardLab& BoardLab::operator=(BoardLab&&) noexcept = default;

std::vector<glm::dmat4> BoardLab::proposePoses(int count, const Progress& progress) const {
    std::vector<glm::dmat4> poses = possiblePoses(count, progress);
    if (static_cast<int>(poses.size()) < count)
        throw InvalidInput("board in the lab", "it does not fit into what camera and projector both see",
                           "use a smaller board, or move camera and projector away");
    return poses;
}

std::vector<glm::dmat4> BoardLab::possiblePoses(int count, const Progress& progress) const {
    std::vector<glm::dmat4> poses;
    if (!data_->isSeen(data_->flatPose())) return poses;
    for (int i = 0; i < count; ++i) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(i) / count, "looking for poses of the board");
        std::mt19937 dice(data_->seed * 7919U + static_cast<std::uint32_t>(i));
        const auto pose = i == 0 ? data_->flatPose() : data_->tiltedPose(i, dice);
        if (pose) poses.push_back(*pose);
    }
    return poses;
}

void BoardLab::lay(const glm::dmat4& worldFromBoard) {
    if (!isRigid(worldFromBoard))
        throw InvalidInput("pose of the board", "it is no rotation and translation", "give a rigid motion in metres");
    data_->worldFromBoard = worldFromBoard;
    data_->isLooked = false;
}

void BoardLab::show(const cv::Mat& grey) {
    const glm::ivec2 size = data_->projector.camera.size;
    if (grey.type() != CV_8U || grey.cols != size.x || grey.rows != size.y)
        throw InvalidInput("picture of the lab's projector",
                           "it is no 8-bit grey picture of " + std::to_string(size.x) + " x " + std::to_string(size.y),
                           "give it a picture of its own size");
    for (int y = 0; y < grey.rows; ++y)
        for (int x = 0; x < grey.cols; ++x) data_->shown(y, x) = data_->light[grey.at<uchar>(y, x)];
}

cv::Mat BoardLab::photograph() {
    data_->look();
    cv::Mat1f light = data_->exposed();
    const BoardLabOptions& options = data_->options;
    std::normal_distribution<double> hand(0.0, std::max(1e-12, options.tremble));
    const cv::Matx23d shift(1.0, 0.0, hand(data_->random), 0.0, 1.0, hand(data_->random));
    if (options.blur > 0.0) cv::GaussianBlur(light, light, {}, options.blur);
    if (options.tremble > 0.0) {
        cv::Mat1f moved;
        cv::warpAffine(light, moved, shift, light.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
        light = moved;
    }
    return withNoise(light, options, data_->seed * 65537U + data_->pictures++);
}

void BoardLab::setCamera(const CalibratedCamera& camera) {
    checkCamera(camera);
    data_->cameraLens = lensOf(camera, "camera of the lab");
    data_->camera = camera;
    data_->isLooked = false;
}

void BoardLab::setProjector(const CalibratedCamera& projector) {
    checkCamera(projector);
    if (projector.size != data_->projector.camera.size)
        throw InvalidInput("projector of the lab", "its picture has another size than before", "make a new lab");
    data_->projectorLens = lensOf(projector, "projector of the lab");
    data_->projector.camera = projector;
    data_->isLooked = false;
}

const CalibratedCamera& BoardLab::camera() const noexcept { return data_->camera; }
const InstalledProjector& BoardLab::projector() const noexcept { return data_->projector; }
const CalibrationBoard& BoardLab::board() const noexcept { return data_->board; }
const BoardLabOptions& BoardLab::options() const noexcept { return data_->options; }

std::vector<glm::dvec3> BoardLab::points() const {
    std::vector<glm::dvec3> all;
    for (const cv::Point3d& point : pointsOf(data_->board)) all.push_back(data_->place(point.x, point.y));
    return all;
}

glm::dvec3 BoardLab::place(double x, double y) const { return data_->place(x, y); }

std::optional<glm::dvec2> BoardLab::cameraPixel(const glm::dvec3& point) const {
    const auto ideal = imageOf(data_->cameraLens, point);
    if (!ideal) return std::nullopt;
    return waved(*ideal, data_->camera.size, data_->options.cameraWave);
}

std::optional<glm::dvec2> BoardLab::projectorPixel(const glm::dvec3& point) const {
    return data_->projectorPixel(point);
}

cv::Mat withNoise(const cv::Mat& light, const BoardLabOptions& options, std::uint32_t seed) {
    const std::vector<float>& grain = grains();
    const auto still = static_cast<float>(options.noise * options.noise);
    const auto shot = static_cast<float>(options.shotNoise);
    cv::Mat1b grey(light.size());
    tbb::parallel_for(0, light.rows, [&](int y) {
        std::uint32_t random = scrambled(scrambled(seed * 2654435761U + static_cast<std::uint32_t>(y) * 40503U + 1U));
        for (int x = 0; x < light.cols; ++x) {
            random = scrambled(random);
            const float value = std::max(0.0F, light.at<float>(y, x));
            const float noise = std::sqrt(still + shot * value) * grain[random % kGrains];
            grey(y, x) = cv::saturate_cast<uchar>(value + noise);
        }
    });
    return grey;
}

CalibratedCamera defaultLabCamera(const CalibratedCamera& projector) {
    // Half a metre to the side and towards the viewer, a little lower than the projector; it sees half as much again
    // as a place of 0.5 m.
    const glm::dvec3 lamp = positionOf(projector);
    const glm::dvec3 position = 0.8 * lamp + glm::dvec3(0.45, 0.0, 0.25);
    constexpr double kSeen = 0.75; // metres, across
    CalibratedCamera camera = cameraLookingAt(position, {0.0, 0.05, 0.0}, {1280, 1024}, 1.0);
    const double focal = camera.size.x * glm::length(position) / kSeen;
    camera.focal = {focal, focal};
    camera.principal = {0.5 * (camera.size.x - 1) - 9.0, 0.5 * (camera.size.y - 1) + 6.0};
    camera.distortion = {-0.18, 0.12, 0.0006, -0.0004, 0.0};
    return camera;
}

CalibratedCamera labCamera(const Installation& room) {
    if (room.projectors.empty()) throw InvalidInput("installation", "it has no projector", "add one in the studio");
    return room.cameras.empty() ? defaultLabCamera(room.projectors.front().camera) : room.cameras.front().camera;
}

Installation withLabCamera(Installation room) {
    const CalibratedCamera camera = labCamera(room);
    if (room.cameras.empty()) room.cameras.push_back({"Camera", "", camera, {}, {}});
    return room;
}

CalibratedCamera withSize(CalibratedCamera camera, glm::ivec2 size) {
    if (size.x < 16 || size.y < 16)
        throw InvalidInput("size of the camera's picture", "it has fewer than 16 pixels a side", "give a larger one");
    const double scale = static_cast<double>(size.x) / camera.size.x;
    camera.focal *= scale;
    camera.principal = scale * (camera.principal + 0.5) - 0.5;
    camera.principal.y += 0.5 * (size.y - scale * camera.size.y);
    camera.size = size;
    return camera;
}

} // namespace lumorph
