#include "calibration/tracking/board_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <opencv2/aruco.hpp>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/error.h"

namespace lumorph {
namespace {

constexpr int kFewestPoints = 6;
constexpr double kWorstFit = 5.0; // pixels
constexpr int kMostSquares = 50;
constexpr double kSameTurn = 0.99; // cosine of half the angle: 16 degrees
constexpr double kDoubt = 2.0;     // a pose that flips over must fit that much better

struct NamedDictionary {
    std::string_view name;
    cv::aruco::PREDEFINED_DICTIONARY_NAME id;
};

constexpr NamedDictionary kDictionaries[] = {
    {"4X4_50", cv::aruco::DICT_4X4_50},
    {"4X4_100", cv::aruco::DICT_4X4_100},
    {"4X4_250", cv::aruco::DICT_4X4_250},
    {"5X5_50", cv::aruco::DICT_5X5_50},
    {"5X5_100", cv::aruco::DICT_5X5_100},
    {"5X5_250", cv::aruco::DICT_5X5_250},
    {"6X6_50", cv::aruco::DICT_6X6_50},
    {"6X6_100", cv::aruco::DICT_6X6_100},
    {"6X6_250", cv::aruco::DICT_6X6_250},
    {"7X7_50", cv::aruco::DICT_7X7_50},
    {"7X7_100", cv::aruco::DICT_7X7_100},
    {"7X7_250", cv::aruco::DICT_7X7_250},
    {"ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
};

const NamedDictionary* dictionaryOf(const MarkerBoard& board) {
    const auto found = std::ranges::find(kDictionaries, board.dictionary, &NamedDictionary::name);
    return found == std::end(kDictionaries) ? nullptr : &*found;
}

int markersOf(const MarkerBoard& board) {
    return board.kind == MarkerBoard::Kind::charuco ? board.columns * board.rows / 2 : board.columns * board.rows;
}

// Between ArUco markers; squares of a chessboard meet.
double gapOf(const MarkerBoard& board) {
    return board.kind == MarkerBoard::Kind::charuco ? 0.0 : board.square - board.marker;
}

// OpenCV's boards have their origin at the upper left corner, and +Y down the page.
cv::Point3f upThePage(const MarkerBoard& board, const cv::Point3f& point) {
    return {point.x, static_cast<float>(board.rows * board.square - gapOf(board)) - point.y, 0.0F};
}

cv::Ptr<cv::aruco::CharucoBoard> charucoBoard(const MarkerBoard& board) {
    return cv::aruco::CharucoBoard::create(board.columns, board.rows, static_cast<float>(board.square),
                                           static_cast<float>(board.marker),
                                           cv::aruco::getPredefinedDictionary(dictionaryOf(board)->id));
}

cv::Ptr<cv::aruco::GridBoard> gridBoard(const MarkerBoard& board) {
    return cv::aruco::GridBoard::create(board.columns, board.rows, static_cast<float>(board.marker),
                                        static_cast<float>(board.square - board.marker),
                                        cv::aruco::getPredefinedDictionary(dictionaryOf(board)->id));
}

glm::dvec2 placeOf(const cv::Point3f& point) { return {point.x, point.y}; }

// Black cells of a marker, those that touch along a row as one box.
void addMarker(std::vector<BlackBox>& boxes, const cv::aruco::Dictionary& dictionary, int id,
               const glm::dvec2& upperLeft, double side) {
    const int cells = dictionary.markerSize + 2;
    cv::Mat marker;
    dictionary.drawMarker(id, cells, marker, 1);
    const double cell = side / cells;
    for (int row = 0; row < cells; ++row)
        for (int begin = 0; begin < cells;) {
            int end = begin;
            while (end < cells && marker.at<std::uint8_t>(row, end) == 0) ++end;
            if (end > begin)
                boxes.push_back({upperLeft + cell * glm::dvec2(begin, -row - 1), cell * glm::dvec2(end - begin, 1)});
            begin = std::max(end, begin + 1);
        }
}

/// Corners of the board and where they were seen.
struct Matches {
    std::vector<cv::Point3f> board;
    std::vector<cv::Point2f> seen;
};

// Metres around a corner in which nothing else is printed.
double clearAround(const MarkerBoard& board) {
    if (board.kind == MarkerBoard::Kind::charuco) return 0.5 * (board.square - board.marker);
    return std::min(board.marker / 8.0, board.square - board.marker);
}

// Markers give their corners to the pixel, and half a pixel off; a corner's own edges give it to a fraction.
void refine(const cv::Mat& picture, const MarkerBoard& board, Matches& matches) {
    if (matches.seen.size() < 2) return;
    const double seen = cv::norm(matches.seen.front() - matches.seen.back());
    const double apart = cv::norm(matches.board.front() - matches.board.back());
    const int room = std::clamp(static_cast<int>(0.8 * clearAround(board) * seen / std::max(apart, 1e-6)), 2, 8);
    cv::cornerSubPix(picture, matches.seen, {room, room}, {-1, -1},
                     {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 0.005});
}

double errorOf(const Matches& matches, const cv::Mat& intrinsics, const cv::Mat& distortion, const cv::Mat& turn,
               const cv::Mat& way) {
    std::vector<cv::Point2f> expected;
    cv::projectPoints(matches.board, turn, way, intrinsics, distortion, expected);
    double sum = 0.0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const cv::Point2f off = expected[i] - matches.seen[i];
        sum += double{off.x} * off.x + double{off.y} * off.y;
    }
    return std::sqrt(sum / static_cast<double>(expected.size()));
}

Pose poseOf(const cv::Mat& turn, const cv::Mat& way) {
    cv::Matx33d rotation;
    cv::Rodrigues(turn, rotation);
    glm::dmat3 matrix;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) matrix[column][row] = rotation(row, column);
    return {{way.at<double>(0), way.at<double>(1), way.at<double>(2)}, glm::normalize(glm::quat_cast(matrix))};
}

Pose poseOf(const glm::dmat4& matrix) {
    return {glm::dvec3(matrix[3]), glm::normalize(glm::quat_cast(glm::dmat3(matrix)))};
}

} // namespace

void checkBoard(const MarkerBoard& board) {
    const auto refuse = [](const std::string& why, const std::string& remedy) {
        throw InvalidInput("marker board", why, remedy);
    };
    const NamedDictionary* dictionary = dictionaryOf(board);
    if (dictionary == nullptr)
        refuse("there is no dictionary '" + board.dictionary + "'", "use one such as 4X4_50 or 6X6_250");
    const int least = board.kind == MarkerBoard::Kind::charuco ? 2 : 1;
    if (board.columns < least || board.rows < least || board.columns > kMostSquares || board.rows > kMostSquares)
        refuse(std::to_string(board.columns) + " x " + std::to_string(board.rows) + " cells",
               "give " + std::to_string(least) + " to " + std::to_string(kMostSquares) + " of them a side");
    if (!(board.square > 0.0) || !(board.marker > 0.0) || !(board.marker < board.square) || !(board.square < 10.0))
        refuse("a cell of " + std::to_string(board.square) + " m with a marker of " + std::to_string(board.marker) +
                   " m",
               "give metres, the marker less than its cell");
    const int there = cv::aruco::getPredefinedDictionary(dictionary->id)->bytesList.rows;
    if (markersOf(board) > there)
        refuse("it needs " + std::to_string(markersOf(board)) + " markers, and the dictionary has " +
                   std::to_string(there),
               "use a larger dictionary");
}

glm::dvec2 sizeOf(const MarkerBoard& board) {
    return glm::dvec2(board.columns, board.rows) * board.square - gapOf(board);
}

struct BoardFinder::Data {
    Data(const MarkerBoard& which, const CalibratedCamera& from) : board(which), camera(from) {
        intrinsics =
            (cv::Mat_<double>(3, 3) << from.focal.x, 0, from.principal.x, 0, from.focal.y, from.principal.y, 0, 0, 1);
        distortion = cv::Mat(1, 5, CV_64F);
        std::copy(from.distortion.begin(), from.distortion.end(), distortion.begin<double>());
        parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_NONE; // `refine` knows how much room there is
        if (which.kind == MarkerBoard::Kind::charuco)
            charuco = charucoBoard(which);
        else
            grid = gridBoard(which);
    }

    [[nodiscard]] Matches matches(const cv::Mat& picture) const;
    [[nodiscard]] std::optional<BoardSighting> sighting(const Matches& matches, const std::optional<Pose>& hint) const;
    [[nodiscard]] int pointCount() const {
        return charuco ? (board.columns - 1) * (board.rows - 1) : 4 * board.columns * board.rows;
    }

    MarkerBoard board;
    CalibratedCamera camera;
    cv::Mat intrinsics, distortion;
    cv::Ptr<cv::aruco::DetectorParameters> parameters = cv::aruco::DetectorParameters::create();
    cv::Ptr<cv::aruco::CharucoBoard> charuco;
    cv::Ptr<cv::aruco::GridBoard> grid;
    int cornersSeen = 0;
};

Matches BoardFinder::Data::matches(const cv::Mat& picture) const {
    const cv::Ptr<cv::aruco::Board> any =
        charuco ? cv::Ptr<cv::aruco::Board>(charuco) : cv::Ptr<cv::aruco::Board>(grid);
    std::vector<std::vector<cv::Point2f>> corners, rejected;
    std::vector<int> ids;
    cv::aruco::detectMarkers(picture, any->dictionary, corners, ids, parameters, rejected);
    Matches found;
    if (ids.empty()) return found;
    if (charuco) {
        std::vector<int> numbers;
        cv::aruco::interpolateCornersCharuco(corners, ids, picture, charuco, found.seen, numbers);
        for (const int number : numbers)
            found.board.push_back(upThePage(board, charuco->chessboardCorners[static_cast<std::size_t>(number)]));
        return found;
    }
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const auto which = std::find(grid->ids.begin(), grid->ids.end(), ids[i]);
        if (which == grid->ids.end()) continue;
        const auto& points = grid->objPoints[static_cast<std::size_t>(which - grid->ids.begin())];
        for (const cv::Point3f& point : points) found.board.push_back(upThePage(board, point));
        found.seen.insert(found.seen.end(), corners[i].begin(), corners[i].end());
    }
    return found;
}

// A plane seen from afar may look alike in two poses: the one that fits better is taken, or, where they fit about as
// well, the one that goes on from before.
std::optional<BoardSighting> BoardFinder::Data::sighting(const Matches& matches,
                                                         const std::optional<Pose>& hint) const {
    if (static_cast<int>(matches.seen.size()) < kFewestPoints) return std::nullopt;
    std::vector<cv::Mat> turns, ways;
    cv::solvePnPGeneric(matches.board, matches.seen, intrinsics, distortion, turns, ways, false, cv::SOLVEPNP_IPPE);
    std::optional<BoardSighting> best;
    double least = 0.0;
    for (std::size_t i = 0; i < turns.size(); ++i) {
        cv::solvePnPRefineLM(matches.board, matches.seen, intrinsics, distortion, turns[i], ways[i]);
        const double error = errorOf(matches, intrinsics, distortion, turns[i], ways[i]);
        if (!(error < kWorstFit) || !(ways[i].at<double>(2) > 0.0)) continue;
        const Pose pose = poseOf(turns[i], ways[i]);
        const bool isTurned = hint && std::abs(glm::dot(pose.rotation, hint->rotation)) < kSameTurn;
        const double cost = isTurned ? kDoubt * error : error;
        if (best && least <= cost) continue;
        const auto points = static_cast<int>(matches.seen.size());
        best = {pose, error, points, static_cast<double>(points) / pointCount()};
        least = cost;
    }
    return best;
}

BoardFinder::BoardFinder(const MarkerBoard& board, const CalibratedCamera& camera) {
    checkBoard(board);
    checkCamera(camera);
    data_ = std::make_unique<Data>(board, camera);
}

BoardFinder::~BoardFinder() = default;
BoardFinder::BoardFinder(BoardFinder&&) noexcept = default;
BoardFinder& BoardFinder::operator=(BoardFinder&&) noexcept = default;

int BoardFinder::cornersSeen() const noexcept { return data_->cornersSeen; }

std::optional<BoardSighting> BoardFinder::find(std::span<const std::uint8_t> grey, const std::optional<Pose>& hint) {
    const glm::ivec2 size = data_->camera.size;
    if (grey.size() != static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y))
        throw InvalidInput("camera picture", "it has another size than the camera was calibrated with",
                           "set the camera to " + std::to_string(size.x) + " x " + std::to_string(size.y));
    // OpenCV only reads it.
    const cv::Mat picture(size.y, size.x, CV_8UC1, const_cast<std::uint8_t*>(grey.data()));
    data_->cornersSeen = 0;
    try {
        Matches matches = data_->matches(picture);
        data_->cornersSeen = static_cast<int>(matches.seen.size());
        refine(picture, data_->board, matches);
        return data_->sighting(matches, hint);
    } catch (const cv::Exception&) { // corners that lie in one line have no pose
        return std::nullopt;
    }
}

Image BoardFinder::page(const MarkerBoard& board, double pixelsPerMetre) {
    checkBoard(board);
    const glm::dvec2 pixels = sizeOf(board) * pixelsPerMetre;
    const cv::Size size(static_cast<int>(std::lround(pixels.x)), static_cast<int>(std::lround(pixels.y)));
    cv::Mat drawn;
    if (board.kind == MarkerBoard::Kind::charuco)
        charucoBoard(board)->draw(size, drawn);
    else
        gridBoard(board)->draw(size, drawn);
    Image page({drawn.cols, drawn.rows});
    for (int y = 0; y < drawn.rows; ++y)
        for (int x = 0; x < drawn.cols; ++x) {
            const std::uint8_t grey = drawn.at<std::uint8_t>(y, x);
            page.at(x, y) = {grey, grey, grey, 255};
        }
    return page;
}

std::vector<BlackBox> BoardFinder::blackBoxes(const MarkerBoard& board) {
    checkBoard(board);
    std::vector<BlackBox> boxes;
    const cv::Ptr<cv::aruco::Board> all = board.kind == MarkerBoard::Kind::charuco
                                              ? cv::Ptr<cv::aruco::Board>(charucoBoard(board))
                                              : cv::Ptr<cv::aruco::Board>(gridBoard(board));
    std::set<std::pair<int, int>> marked; // squares that hold a marker
    for (std::size_t i = 0; i < all->ids.size(); ++i) {
        const glm::dvec2 upper = placeOf(upThePage(board, all->objPoints[i].front()));
        addMarker(boxes, *all->dictionary, all->ids[i], upper, board.marker);
        marked.emplace(static_cast<int>(upper.x / board.square), static_cast<int>(upper.y / board.square));
    }
    if (board.kind == MarkerBoard::Kind::charuco)
        for (int column = 0; column < board.columns; ++column)
            for (int row = 0; row < board.rows; ++row)
                if (!marked.contains({column, row}))
                    boxes.push_back({board.square * glm::dvec2(column, row), glm::dvec2(board.square)});
    return boxes;
}

Pose worldFromDevice(const BoardSighting& sighting, const CalibratedCamera& camera, const Pose& deviceFromBoard) {
    const Pose worldFromCamera = inverseOf(poseOf(camera.cameraFromWorld));
    return worldFromCamera * sighting.cameraFromBoard * inverseOf(deviceFromBoard);
}

} // namespace lumorph
