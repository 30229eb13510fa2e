#include "calibration/tracking/board_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <glm/vec2.hpp>

#include "calibration/lab/board_texture.h"

namespace lumorph {

namespace {

constexpr double kPointsPerMillimetre = 72.0 / 25.4;
constexpr glm::dvec2 kSheets[] = {{210.0, 297.0}, {297.0, 210.0}, {297.0, 420.0}, {420.0, 297.0}}; ///< A4, A3
constexpr double kMargin = 8.0;         ///< millimetres; printers leave about 5 white
constexpr double kFoot = 20.0;          ///< for the words below
constexpr double kRuler = 100.0;        ///< a line of that length
constexpr double kRound = 0.5522847498; ///< of a radius: where a quarter circle's curve has its control points

/// What is printed black, from the lower left corner of the pattern upwards; millimetres.
struct Print {
    glm::dvec2 size{0.0};
    std::vector<BlackBox> boxes;
    std::vector<glm::dvec2> circles;
    double radius = 0.0;
    std::string words;
    std::string measure; ///< what to measure on it
};

/// At most four digits after the point: a PDF knows no exponents.
std::string digits(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4f", value);
    return text;
}

std::string millimetres(double metres) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", std::round(1e7 * metres) / 1e4);
    return text;
}

/// A4 or A3, standing or lying, or a sheet as large as needed; millimetres.
glm::dvec2 sheetFor(const glm::dvec2& pattern) {
    const glm::dvec2 needed = pattern + glm::dvec2(2.0 * kMargin, 2.0 * kMargin + kFoot);
    for (const glm::dvec2& sheet : kSheets)
        if (needed.x <= sheet.x && needed.y <= sheet.y) return sheet;
    return {std::max(needed.x, kRuler + 2.0 * kMargin), needed.y};
}

std::string pair(const glm::dvec2& value) { return digits(value.x) + " " + digits(value.y) + " "; }

/// A closed path of four curves.
std::string circle(const glm::dvec2& middle, double radius) {
    std::string out = pair(middle + glm::dvec2(radius, 0.0)) + "m\n";
    glm::dvec2 from(radius, 0.0);
    for (int quarter = 0; quarter < 4; ++quarter) {
        const glm::dvec2 to(-from.y, from.x);
        out += pair(middle + from + kRound * to) + pair(middle + to + kRound * from) + pair(middle + to) + "c\n";
        from = to;
    }
    return out + "h\n";
}

/// What is drawn on the sheet; its unit is the millimetre, its origin the lower left corner.
std::string drawing(const Print& print, const glm::dvec2& sheet) {
    const glm::dvec2 corner(0.5 * (sheet.x - print.size.x), kFoot + 0.5 * (sheet.y - kFoot - print.size.y));
    std::string out = digits(kPointsPerMillimetre) + " 0 0 " + digits(kPointsPerMillimetre) + " 0 0 cm\n0 g\n";
    // One path for all, so that no seams show where boxes meet.
    for (const BlackBox& box : print.boxes) out += pair(corner + box.corner) + pair(box.size) + "re\n";
    for (const glm::dvec2& middle : print.circles) out += circle(corner + middle, print.radius);
    out += "f\n";
    const double left = 0.5 * (sheet.x - kRuler);
    out += "0.2 w " + digits(left) + " 18 m " + digits(left + kRuler) + " 18 l S\n";
    for (const double x : {left, left + kRuler}) out += digits(x) + " 17 m " + digits(x) + " 19 l S\n";
    const auto words = [&](double y, const std::string& line) {
        out += "BT /F1 3 Tf " + digits(left) + " " + digits(y) + " Td (" + line + ") Tj ET\n";
    };
    words(13.5, "Print at 100 %, not fitted to the page: this line is then 100 mm long.");
    words(9.5, print.words + ".");
    if (!print.measure.empty()) words(5.5, print.measure);
    return out;
}

/// A file of one page.
std::string pdfOf(const Print& print) {
    const glm::dvec2 sheet = sheetFor(print.size);
    const glm::dvec2 points = sheet * kPointsPerMillimetre;
    const std::string content = drawing(print, sheet);
    const std::vector<std::string> objects{
        "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + digits(points.x) + " " + digits(points.y) +
            "] /Contents 4 0 R /Resources << /Font << /F1 5 0 R >> >> >>",
        "<< /Length " + std::to_string(content.size()) + " >>\nstream\n" + content + "endstream",
        "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>",
        "<< /Title (" + print.words + ") >>"};
    std::string pdf = "%PDF-1.4\n";
    std::string table = "xref\n0 " + std::to_string(objects.size() + 1) + "\n0000000000 65535 f \n";
    for (std::size_t i = 0; i < objects.size(); ++i) {
        char entry[32];
        std::snprintf(entry, sizeof entry, "%010zu 00000 n \n", pdf.size());
        table += entry;
        pdf += std::to_string(i + 1) + " 0 obj\n" + objects[i] + "\nendobj\n";
    }
    const std::size_t start = pdf.size();
    return pdf + table + "trailer\n<< /Size " + std::to_string(objects.size() + 1) +
           " /Root 1 0 R /Info 6 0 R >>\nstartxref\n" + std::to_string(start) + "\n%%EOF\n";
}

/// Black cells of the squares of a chessboard or ChArUco board, by how the lab prints it.
std::vector<BlackBox> cellsOf(const CalibrationBoard& board) {
    const BoardTexture texture(board);
    const bool isChess = board.kind == CalibrationBoard::Kind::chess;
    const int first = isChess ? -1 : 0; // the outermost squares of a chessboard have inner corners on one side
    const double side = board.spacing;
    std::vector<BlackBox> boxes;
    const auto add = [&](double x, double y, double size) { // y runs down the board, and up the page
        boxes.push_back({{x - first * side, (board.rows * side - y) - size}, {size, size}});
    };
    const double edge = 0.5 * (side - board.marker);
    const double cell = board.marker / texture.markerCells();
    for (int row = first; row < board.rows; ++row)
        for (int column = first; column < board.columns; ++column) {
            const double x = side * column, y = side * row;
            const auto isBlack = [&](double dx, double dy) { return texture.albedo(x + dx, y + dy) < 0.5F; };
            if (isBlack(0.02 * side, 0.02 * side)) { // beside a marker a square is white
                add(x, y, side);
                continue;
            }
            for (int j = 0; !isChess && j < texture.markerCells(); ++j)
                for (int i = 0; i < texture.markerCells(); ++i)
                    if (isBlack(edge + (i + 0.5) * cell, edge + (j + 0.5) * cell))
                        add(x + edge + i * cell, y + edge + j * cell, cell);
        }
    return boxes;
}

std::string measureOf(int count, const char* what, double one) {
    return "Measure " + std::to_string(count) + " " + what + ": " + millimetres(1e-3 * count * one) +
           " mm. Where they are longer or shorter, say so in the studio: a share of it as the length of one.";
}

} // namespace

std::string wordsOf(const MarkerBoard& board) {
    const bool chess = board.kind == MarkerBoard::Kind::charuco;
    return std::string(chess ? "ChArUco, " : "ArUco, ") + std::to_string(board.columns) + " x " +
           std::to_string(board.rows) + (chess ? " squares of " : " markers every ") + millimetres(board.square) +
           " mm, markers of " + millimetres(board.marker) + " mm, dictionary " + board.dictionary;
}

std::string queryOf(const MarkerBoard& board) {
    const std::string kind = board.kind == MarkerBoard::Kind::charuco ? "" : "kind=aruco&";
    return kind + "squares=" + std::to_string(board.columns) + "x" + std::to_string(board.rows) +
           "&size=" + millimetres(board.square) + "&marker=" + millimetres(board.marker) +
           "&dictionary=" + board.dictionary;
}

std::string boardPdf(const MarkerBoard& board) {
    checkBoard(board);
    Print print{1e3 * sizeOf(board), BoardFinder::blackBoxes(board), {}, 0.0, wordsOf(board), {}};
    for (BlackBox& box : print.boxes) box = {1e3 * box.corner, 1e3 * box.size};
    return pdfOf(print);
}

std::string calibrationBoardPdf(const CalibrationBoard& board) {
    const std::string count = std::to_string(board.columns) + " x " + std::to_string(board.rows);
    const std::string length = millimetres(1e-3 * board.spacing) + " mm";
    Print print;
    switch (board.kind) {
    case CalibrationBoard::Kind::chess:
        print.size = board.spacing * glm::dvec2(board.columns + 1, board.rows + 1);
        print.words = "Chessboard, " + count + " inner corners, squares of " + length;
        print.measure = measureOf(board.columns + 1, "squares in a row", board.spacing);
        break;
    case CalibrationBoard::Kind::charuco:
        print.size = board.spacing * glm::dvec2(board.columns, board.rows);
        print.words =
            "ChArUco, " + count + " squares of " + length + ", markers of " + millimetres(1e-3 * board.marker) + " mm";
        print.measure = measureOf(board.columns, "squares in a row", board.spacing);
        break;
    case CalibrationBoard::Kind::circles:
        print.size = board.spacing * glm::dvec2(2 * board.columns + 1, board.rows + 1);
        print.words = "Circles, " + count + ", every second row shifted, half a gap of " + length;
        print.measure =
            measureOf(2 * (board.columns - 1), "half gaps from the first to the last circle of a row", board.spacing);
        print.radius = 0.4 * board.spacing;
        for (const cv::Point3d& point : pointsOf(board))
            print.circles.emplace_back(point.x + board.spacing, print.size.y - board.spacing - point.y);
        break;
    }
    if (board.kind != CalibrationBoard::Kind::circles) print.boxes = cellsOf(board);
    return pdfOf(print);
}

} // namespace lumorph
