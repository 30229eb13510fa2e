#include "calibration/decode/calibration_board.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <span>
#include <utility>

#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {

namespace {

constexpr int kMostPoints = 60; // a side
constexpr double kLongest = 1e5;
constexpr int kFewestSeen = 8;

std::vector<std::string_view> splitAt(std::string_view text, char mark) {
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(mark, begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

/// Zero where it is none.
template <typename Number> Number numberIn(std::string_view text) {
    Number value{};
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    return read.ec == std::errc() && read.ptr == text.data() + text.size() ? value : Number{};
}

struct NamedDictionary {
    std::string_view name;
    cv::aruco::PREDEFINED_DICTIONARY_NAME id;
    int markers;
};
/// By family, the smaller first: each begins with the markers of those before it.
constexpr NamedDictionary kNamedDictionaries[] = {
    {"4X4_50", cv::aruco::DICT_4X4_50, 50},
    {"4X4_100", cv::aruco::DICT_4X4_100, 100},
    {"4X4_250", cv::aruco::DICT_4X4_250, 250},
    {"4X4_1000", cv::aruco::DICT_4X4_1000, 1000},
    {"5X5_50", cv::aruco::DICT_5X5_50, 50},
    {"5X5_100", cv::aruco::DICT_5X5_100, 100},
    {"5X5_250", cv::aruco::DICT_5X5_250, 250},
    {"5X5_1000", cv::aruco::DICT_5X5_1000, 1000},
    {"6X6_50", cv::aruco::DICT_6X6_50, 50},
    {"6X6_100", cv::aruco::DICT_6X6_100, 100},
    {"6X6_250", cv::aruco::DICT_6X6_250, 250},
    {"6X6_1000", cv::aruco::DICT_6X6_1000, 1000},
    {"7X7_50", cv::aruco::DICT_7X7_50, 50},
    {"7X7_100", cv::aruco::DICT_7X7_100, 100},
    {"7X7_250", cv::aruco::DICT_7X7_250, 250},
    {"7X7_1000", cv::aruco::DICT_7X7_1000, 1000},
    {"ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL, 1024},
    {"APRILTAG_16h5", cv::aruco::DICT_APRILTAG_16h5, 30},
    {"APRILTAG_25h9", cv::aruco::DICT_APRILTAG_25h9, 35},
    {"APRILTAG_36h10", cv::aruco::DICT_APRILTAG_36h10, 2320},
    {"APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11, 587},
};
/// Those that are looked for where none is said: of each family the one that is used most.
constexpr std::string_view kSearchedDictionaries[] = {"4X4_100",       "6X6_250",        "5X5_250",
                                                      "7X7_250",       "ARUCO_ORIGINAL", "APRILTAG_36h11",
                                                      "APRILTAG_25h9", "APRILTAG_16h5",  "APRILTAG_36h10"};
constexpr int kMostMarkersUnsaid = 100;

/// As people write them: DICT_6X6_250, 6x6_250. Null for other names.
const NamedDictionary* dictionaryNamed(std::string_view name) {
    std::string wanted = lowerCase(name);
    if (wanted.starts_with("dict_")) wanted.erase(0, 5);
    const auto found = std::ranges::find_if(
        kNamedDictionaries, [&wanted](const NamedDictionary& one) { return lowerCase(one.name) == wanted; });
    return found == std::end(kNamedDictionaries) ? nullptr : &*found;
}

int markersOn(const CalibrationBoard& board) { return board.columns * board.rows / 2; }

/// "6X6" of "6X6_250"; markers of one family are the same.
std::string_view familyOf(std::string_view dictionary) {
    const std::size_t end = dictionary.find('_');
    const bool isGrid = !dictionary.empty() && dictionary.front() >= '4' && dictionary.front() <= '7';
    return isGrid ? dictionary.substr(0, end) : dictionary;
}

/// Corners by the edges around them, within half a square.
void refineCorners(const cv::Mat& grey, std::vector<cv::Point2f>& corners, double reach) {
    const int room = std::clamp(static_cast<int>(reach), 2, 11);
    cv::cornerSubPix(grey, corners, {room, room}, {-1, -1},
                     {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 0.001});
}

/// The least distance between points that follow one another.
double leastDistance(const std::vector<cv::Point2f>& points) {
    double least = kLongest;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) least = std::min(least, cv::norm(points[i] - points[i + 1]));
    return least;
}

/// The picture with every place as bright as its surroundings are on average: a board in a projector's light has bright
/// paper on one side and its own deep shadow on the other, and no normalisation of the whole picture suits both.
cv::Mat evenlyLit(const cv::Mat& grey) {
    constexpr double kMean = 100.0; // of 255: white squares come to about twice that
    constexpr double kNoise = 10.0; // what is darker all around is noise, which stays dark
    const int reach = std::max(31, std::min(grey.cols, grey.rows) / 8) | 1;
    cv::Mat light, mean, even;
    grey.convertTo(light, CV_32F);
    cv::blur(light, mean, cv::Size(reach, reach));
    cv::Mat(kMean * light / (mean + kNoise)).convertTo(even, CV_8U);
    return even;
}

cv::Mat negativeOf(const cv::Mat& grey) {
    cv::Mat negative;
    cv::bitwise_not(grey, negative);
    return negative;
}

std::vector<cv::Point2f> findChess(const cv::Mat& grey, cv::Size size) {
    std::vector<cv::Point2f> corners;
    if (cv::findChessboardCornersSB(grey, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_ACCURACY))
        return corners;
    if (!cv::findChessboardCorners(grey, size, corners, cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE) &&
        !cv::findChessboardCornersSB(evenlyLit(grey), size, corners, cv::CALIB_CB_ACCURACY))
        return {};
    refineCorners(grey, corners, 0.35 * leastDistance(corners));
    return corners;
}

/// Dark circles on light; large ones too, which the finder's own blobs are not.
std::vector<cv::Point2f> findCircles(const cv::Mat& grey, cv::Size size) {
    cv::SimpleBlobDetector::Params blobs;
    blobs.minArea = 20.0F;
    blobs.maxArea = 0.02F * static_cast<float>(grey.total());
    std::vector<cv::Point2f> centres;
    const bool found =
        cv::findCirclesGrid(grey, size, centres, cv::CALIB_CB_ASYMMETRIC_GRID | cv::CALIB_CB_CLUSTERING,
                            cv::SimpleBlobDetector::create(blobs)) ||
        cv::findCirclesGrid(grey, size, centres, cv::CALIB_CB_ASYMMETRIC_GRID, cv::SimpleBlobDetector::create(blobs));
    return found ? centres : std::vector<cv::Point2f>{};
}

/// A marker that was seen, and where it is on the board: four corners, clockwise as it is read.
struct SeenMarker {
    cv::Point square;
    std::array<cv::Point2f, 4> board, seen;
};

/// Where a marker's corners are on the board.
std::array<cv::Point2f, 4> markerCorners(const CalibrationBoard& board, const cv::Point& square) {
    const double edge = 0.5 * (board.spacing - board.marker);
    const cv::Point2d at(board.spacing * square.x + edge, board.spacing * square.y + edge);
    const double side = board.marker;
    return {cv::Point2f(at), cv::Point2f(at + cv::Point2d(side, 0.0)), cv::Point2f(at + cv::Point2d(side, side)),
            cv::Point2f(at + cv::Point2d(0.0, side))};
}

/// From the board to the picture by some of its markers; empty where they tell none.
cv::Mat homographyOf(const std::vector<const SeenMarker*>& markers, double tolerance = 0.0, cv::Mat* fits = nullptr) {
    std::vector<cv::Point2f> board, seen;
    for (const SeenMarker* marker : markers) {
        board.insert(board.end(), marker->board.begin(), marker->board.end());
        seen.insert(seen.end(), marker->seen.begin(), marker->seen.end());
    }
    return fits == nullptr ? cv::findHomography(board, seen)
                           : cv::findHomography(board, seen, cv::RANSAC, tolerance, *fits);
}

cv::Point2d throughHomography(const cv::Mat& homography, double x, double y) {
    const cv::Vec3d point = cv::Matx33d(homography) * cv::Vec3d(x, y, 1.0);
    return {point[0] / point[2], point[1] / point[2]};
}

double sideOf(const SeenMarker& marker) {
    double longest = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
        longest = std::max(longest, cv::norm(marker.seen[i] - marker.seen[(i + 1) % 4]));
    return longest;
}

double shortSideOf(const SeenMarker& marker) {
    double shortest = kLongest;
    for (std::size_t i = 0; i < 4; ++i)
        shortest = std::min(shortest, cv::norm(marker.seen[i] - marker.seen[(i + 1) % 4]));
    return shortest;
}

/// Of what was seen, the markers that lie to one another as on such a board; fewer than two are none.
std::vector<SeenMarker> markersOfBoard(const CalibrationBoard& board, const std::vector<int>& ids,
                                       const std::vector<std::vector<cv::Point2f>>& corners) {
    const std::vector<cv::Point> squares = markerSquaresOf(board);
    std::vector<SeenMarker> all;
    double side = 0.0;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const auto id = static_cast<std::size_t>(ids[i]);
        if (ids[i] < 0 || id >= squares.size()) continue;
        SeenMarker marker{squares[id], markerCorners(board, squares[id]), {}};
        std::ranges::copy_n(corners[i].begin(), 4, marker.seen.begin());
        side = std::max(side, sideOf(marker));
        all.push_back(marker);
    }
    if (all.size() < 2) return {};
    std::vector<const SeenMarker*> pointers;
    pointers.reserve(all.size());
    for (const SeenMarker& marker : all) pointers.push_back(&marker);
    constexpr double kTolerance = 0.35; // of a marker's side: a lens bends a board, a wrong layout moves it by a square
    cv::Mat fits;
    if (homographyOf(pointers, std::max(2.0, kTolerance * side), &fits).empty()) return {};
    std::vector<SeenMarker> good;
    for (std::size_t i = 0; i < all.size(); ++i) {
        int fitting = 0;
        for (std::size_t k = 0; k < 4; ++k) fitting += fits.at<uchar>(static_cast<int>(4 * i + k)) != 0 ? 1 : 0;
        if (fitting == 4) good.push_back(all[i]);
    }
    if (good.size() < 2) return {};
    return good;
}

/// Whether dark and white squares meet there as at a corner in sight: something in front of it, or the end of the
/// picture, leaves other greys. `reach` is how far from the corner, on the board, nothing but squares is printed.
bool isCornerInSight(const cv::Mat& grey, const cv::Mat& homography, const cv::Point3d& corner, double reach) {
    constexpr double kContrast = 8.0; // grey levels
    double low[2] = {}, high[2] = {}; // of both diagonals
    for (int i = 0; i < 4; ++i) {
        const int diagonal = i % 2;
        const double x = corner.x + (i == 0 || i == 1 ? reach : -reach);
        const double y = corner.y + (i == 0 || i == 3 ? reach : -reach);
        const cv::Point at = throughHomography(homography, x, y);
        if (at.x < 0 || at.y < 0 || at.x >= grey.cols || at.y >= grey.rows) return false;
        const double level = grey.at<uchar>(at);
        low[diagonal] = i < 2 ? level : std::min(low[diagonal], level);
        high[diagonal] = i < 2 ? level : std::max(high[diagonal], level);
    }
    return low[0] > high[1] + kContrast || low[1] > high[0] + kContrast;
}

/// Corners whose place follows from markers beside them.
BoardPoints cornersOf(const cv::Mat& grey, const CalibrationBoard& board, const std::vector<SeenMarker>& markers) {
    constexpr std::size_t kNearest = 4;
    const double gap = 0.5 * (board.spacing - board.marker);
    BoardPoints points;
    std::vector<cv::Point2f> guesses;
    std::vector<cv::Mat> homographies;
    std::vector<double> reaches; // pixels around each in which nothing but squares is printed
    for (const cv::Point3d& corner : pointsOf(board)) {
        const auto squaresAway = [&](const SeenMarker* marker) {
            return std::max(std::abs(marker->square.x + 0.5 - corner.x / board.spacing),
                            std::abs(marker->square.y + 0.5 - corner.y / board.spacing));
        };
        std::vector<const SeenMarker*> nearest;
        nearest.reserve(markers.size());
        for (const SeenMarker& marker : markers) nearest.push_back(&marker);
        std::ranges::stable_sort(nearest, {}, squaresAway);
        if (squaresAway(nearest.front()) > 0.6) continue; // no marker beside it was seen
        nearest.resize(std::min(kNearest, nearest.size()));
        const cv::Mat homography = homographyOf(nearest);
        if (homography.empty()) continue;
        const cv::Point2d guess = throughHomography(homography, corner.x, corner.y);
        if (!(guess.x >= 1.0 && guess.y >= 1.0 && guess.x < grey.cols - 2.0 && guess.y < grey.rows - 2.0)) continue;
        points.board.push_back(corner);
        guesses.emplace_back(guess);
        homographies.push_back(homography);
        reaches.push_back(0.8 * gap * shortSideOf(*nearest.front()) / board.marker);
    }
    if (guesses.empty()) return {};
    BoardPoints good;
    for (std::size_t i = 0; i < guesses.size(); ++i) {
        std::vector<cv::Point2f> seen{guesses[i]};
        const double reach = reaches[i];
        refineCorners(grey, seen, reach);
        if (cv::norm(seen.front() - guesses[i]) > std::max(2.0, reach)) continue;
        const bool isLargeEnough = reach > 2.5; // to look beside the corner
        if (isLargeEnough && !isCornerInSight(grey, homographies[i], points.board[i], 0.6 * gap)) continue;
        good.board.push_back(points.board[i]);
        good.seen.emplace_back(seen.front());
    }
    return good;
}

/// Whether so many points tell a pose: not all in a line.
bool tellsPose(const CalibrationBoard& board, const BoardPoints& points) {
    const int all = (board.columns - 1) * (board.rows - 1);
    if (static_cast<int>(points.seen.size()) < std::min(kFewestSeen, all)) return false;
    const cv::Point3d& first = points.board.front();
    const auto isOther = [&](double cv::Point3d::*axis) {
        return std::ranges::any_of(points.board, [&](const cv::Point3d& one) { return one.*axis != first.*axis; });
    };
    return isOther(&cv::Point3d::x) && isOther(&cv::Point3d::y);
}

/// A chessboard in the fast way alone: white on black is rare, and most pictures without a board have none.
std::vector<cv::Point2f> findWhiteOnBlack(const cv::Mat& grey, cv::Size size, bool isChess) {
    const cv::Mat negative = negativeOf(grey);
    if (!isChess) return findCircles(negative, size);
    std::vector<cv::Point2f> corners;
    if (!cv::findChessboardCornersSB(negative, size, corners, cv::CALIB_CB_ACCURACY)) return {};
    return corners;
}

/// With markers of one dictionary, in the layout in which more of them lie as they should.
BoardPoints findWith(const cv::Mat& grey, CalibrationBoard board, const NamedDictionary& dictionary) {
    if (markersOn(board) > dictionary.markers) return {};
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    cv::aruco::detectMarkers(grey, cv::aruco::getPredefinedDictionary(dictionary.id), corners, ids);
    if (ids.size() < 2) return {};
    std::vector<SeenMarker> markers = markersOfBoard(board, ids, corners);
    CalibrationBoard other = board;
    other.isOldLayout = !board.isOldLayout;
    if (board.rows % 2 == 0)
        if (auto otherwise = markersOfBoard(other, ids, corners); otherwise.size() > markers.size()) {
            markers = std::move(otherwise);
            board = other;
        }
    if (markers.empty()) return {};
    BoardPoints points = cornersOf(grey, board, markers);
    points.dictionary = dictionary.name;
    return tellsPose(board, points) ? points : BoardPoints{};
}

BoardPoints findCharuco(const cv::Mat& grey, const CalibrationBoard& board) {
    std::vector<const NamedDictionary*> wanted;
    if (const NamedDictionary* said = dictionaryNamed(board.dictionary)) wanted.push_back(said);
    for (const std::string_view name : kSearchedDictionaries)
        if (wanted.empty() || familyOf(name) != familyOf(wanted.front()->name)) wanted.push_back(dictionaryNamed(name));
    for (const bool isNegative : {false, true}) {
        const cv::Mat picture = isNegative ? negativeOf(grey) : grey;
        for (const NamedDictionary* dictionary : wanted)
            if (BoardPoints found = findWith(picture, board, *dictionary); !found.seen.empty()) return found;
    }
    return {};
}

} // namespace

CalibrationBoard parseCalibrationBoard(std::string_view text) {
    const auto refuse = [&text](const std::string& why) {
        throw InvalidInput("board " + inQuotes(text), why,
                           "write chess:9x7:75 (inner corners, side of a square), circles:4x11:20, charuco:5x7:30:22 "
                           "(squares, side of a square, side of a marker) or charuco:5x7:30:22:6X6_250");
    };
    const auto parts = splitAt(text, ':');
    CalibrationBoard board;
    if (parts[0] == "chess")
        board.kind = CalibrationBoard::Kind::chess;
    else if (parts[0] == "circles")
        board.kind = CalibrationBoard::Kind::circles;
    else if (parts[0] == "charuco")
        board.kind = CalibrationBoard::Kind::charuco;
    else
        refuse("there is no such kind of board");
    const bool hasMarkers = board.kind == CalibrationBoard::Kind::charuco;
    if (hasMarkers ? parts.size() < 4 || parts.size() > 6 : parts.size() != 3)
        refuse(hasMarkers ? "it has not four parts, and a dictionary where it is known" : "it has not three parts");
    const auto sides = splitAt(parts[1], 'x');
    board.columns = sides.size() == 2 ? numberIn<int>(sides[0]) : 0;
    board.rows = sides.size() == 2 ? numberIn<int>(sides[1]) : 0;
    if (board.columns < 3 || board.rows < 3 || board.columns > kMostPoints || board.rows > kMostPoints)
        refuse(inQuotes(parts[1]) + " is no size from 3x3 to 60x60");
    board.spacing = numberIn<double>(parts[2]);
    if (!(board.spacing > 0.0) || !(board.spacing < kLongest)) refuse(inQuotes(parts[2]) + " is no length");
    if (!hasMarkers) return board;
    board.marker = numberIn<double>(parts[3]);
    if (!(board.marker > 0.0) || !(board.marker < board.spacing)) refuse("a marker must be smaller than its square");
    for (const std::string_view part : std::span(parts).subspan(4)) {
        if (part == "old") {
            board.isOldLayout = true;
        } else if (const NamedDictionary* dictionary = dictionaryNamed(part); dictionary && board.dictionary.empty()) {
            board.dictionary = dictionary->name;
        } else {
            refuse(inQuotes(part) + " is no dictionary of markers, such as 4X4_50, 6X6_250 or APRILTAG_36h11");
        }
    }
    const NamedDictionary* dictionary = dictionaryNamed(board.dictionary);
    const int markers = dictionary ? dictionary->markers : kMostMarkersUnsaid;
    if (markersOn(board) > markers)
        refuse("it needs more markers than the " + std::to_string(markers) + " of " +
               (dictionary ? board.dictionary : "a dictionary that is found by itself; name it"));
    return board;
}

std::string boardText(const CalibrationBoard& board) {
    const auto lengthText = [](double length) {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "%.10g", length);
        return std::string(text.data());
    };
    const std::string size = std::to_string(board.columns) + "x" + std::to_string(board.rows);
    switch (board.kind) {
    case CalibrationBoard::Kind::circles:
        return "circles:" + size + ":" + lengthText(board.spacing);
    case CalibrationBoard::Kind::charuco:
        return "charuco:" + size + ":" + lengthText(board.spacing) + ":" + lengthText(board.marker) +
               (board.dictionary.empty() ? "" : ":" + board.dictionary) + (board.isOldLayout ? ":old" : "");
    case CalibrationBoard::Kind::chess:
        break;
    }
    return "chess:" + size + ":" + lengthText(board.spacing);
}

std::vector<std::string> markerDictionaries() {
    std::vector<std::string> names;
    for (const NamedDictionary& dictionary : kNamedDictionaries) names.emplace_back(dictionary.name);
    return names;
}

int markerDictionaryOf(const CalibrationBoard& board) {
    if (const NamedDictionary* said = dictionaryNamed(board.dictionary)) return said->id;
    return std::ranges::find_if(kNamedDictionaries,
                                [&](const NamedDictionary& one) { return one.markers >= markersOn(board); })
        ->id;
}

std::vector<cv::Point> markerSquaresOf(const CalibrationBoard& board) {
    const int first = board.isOldLayout && board.rows % 2 == 0 ? 0 : 1; // of the upper row
    std::vector<cv::Point> squares;
    for (int row = 0; row < board.rows; ++row)
        for (int column = 0; column < board.columns; ++column)
            if ((row + column) % 2 == first) squares.emplace_back(column, row);
    return squares;
}

std::optional<Finding> checkBoardKind(const std::string& view, const CalibrationBoard& said, const BoardPoints& found) {
    constexpr std::string_view kUsualFamily = "4X4";
    if (said.kind != CalibrationBoard::Kind::charuco || found.dictionary.empty()) return std::nullopt;
    const std::string_view family = familyOf(found.dictionary);
    if (family == (said.dictionary.empty() ? kUsualFamily : familyOf(said.dictionary))) return std::nullopt;
    CalibrationBoard seen = said;
    seen.dictionary = found.dictionary;
    return Finding{Cause::boardKind, view, "",
                   "the board's markers are of the dictionary " + found.dictionary +
                       (said.dictionary.empty() ? ", which was not said" : ", not " + said.dictionary + " as was said"),
                   "nothing has to be done; --board " + boardText(seen) + " is found faster"};
}

std::vector<cv::Point3d> pointsOf(const CalibrationBoard& board) {
    std::vector<cv::Point3d> points;
    const bool charuco = board.kind == CalibrationBoard::Kind::charuco;
    const int first = charuco ? 1 : 0;
    for (int row = first; row < board.rows; ++row)
        for (int column = first; column < board.columns; ++column) {
            const bool circles = board.kind == CalibrationBoard::Kind::circles;
            const int across = circles ? 2 * column + row % 2 : column;
            points.emplace_back(board.spacing * across, board.spacing * row, 0.0);
        }
    return points;
}

std::optional<BoardPoints> findBoard(const cv::Mat& grey, const CalibrationBoard& board) {
    const cv::Size size(board.columns, board.rows);
    BoardPoints found;
    try {
        if (board.kind == CalibrationBoard::Kind::charuco) {
            found = findCharuco(grey, board);
        } else {
            const bool isChess = board.kind == CalibrationBoard::Kind::chess;
            std::vector<cv::Point2f> seen = isChess ? findChess(grey, size) : findCircles(grey, size);
            if (seen.empty()) seen = findWhiteOnBlack(grey, size, isChess);
            if (!seen.empty()) found = {pointsOf(board), {seen.begin(), seen.end()}};
        }
    } catch (const cv::Exception&) { // what looked like a board is none
        return std::nullopt;
    }
    if (found.seen.empty()) return std::nullopt;
    return found;
}

} // namespace lumorph
