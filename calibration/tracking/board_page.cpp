#include "calibration/tracking/board_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <glm/vec2.hpp>

namespace lumorph {

namespace {

constexpr double kPointsPerMillimetre = 72.0 / 25.4;
constexpr glm::dvec2 kA4{210.0, 297.0};
constexpr double kMargin = 8.0;  ///< millimetres; printers leave about 5 white
constexpr double kFoot = 16.0;   ///< for the words below
constexpr double kRuler = 100.0; ///< a line of that length

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

/// A4, standing or lying, or a sheet as large as needed; millimetres.
glm::dvec2 sheetFor(const glm::dvec2& board) {
    const glm::dvec2 needed = board + glm::dvec2(2.0 * kMargin, 2.0 * kMargin + kFoot);
    const auto holds = [&](const glm::dvec2& sheet) { return needed.x <= sheet.x && needed.y <= sheet.y; };
    if (holds(kA4)) return kA4;
    if (holds({kA4.y, kA4.x})) return {kA4.y, kA4.x};
    return {std::max(needed.x, kRuler + 2.0 * kMargin), needed.y};
}

/// What is drawn on the sheet; its unit is the millimetre, its origin the lower left corner.
std::string drawing(const MarkerBoard& board, const glm::dvec2& sheet) {
    const glm::dvec2 size = 1e3 * sizeOf(board);
    const glm::dvec2 corner(0.5 * (sheet.x - size.x), kFoot + 0.5 * (sheet.y - kFoot - size.y));
    std::string out = digits(kPointsPerMillimetre) + " 0 0 " + digits(kPointsPerMillimetre) + " 0 0 cm\n0 g\n";
    // One path for all, so that no seams show where boxes meet.
    for (const BlackBox& box : BoardFinder::blackBoxes(board)) {
        const glm::dvec2 at = corner + 1e3 * box.corner;
        out += digits(at.x) + " " + digits(at.y) + " " + digits(1e3 * box.size.x) + " " + digits(1e3 * box.size.y) +
               " re\n";
    }
    out += "f\n";
    const double left = 0.5 * (sheet.x - kRuler);
    out += "0.2 w " + digits(left) + " 14 m " + digits(left + kRuler) + " 14 l S\n";
    for (const double x : {left, left + kRuler}) out += digits(x) + " 13 m " + digits(x) + " 15 l S\n";
    const auto words = [&](double y, const std::string& line) {
        out += "BT /F1 3 Tf " + digits(left) + " " + digits(y) + " Td (" + line + ") Tj ET\n";
    };
    words(9.5, "Print at 100 %, not fitted to the page: this line is then 100 mm long.");
    words(5.5, wordsOf(board) + ".");
    return out;
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
    const glm::dvec2 sheet = sheetFor(1e3 * sizeOf(board));
    const glm::dvec2 points = sheet * kPointsPerMillimetre;
    const std::string content = drawing(board, sheet);
    const std::vector<std::string> objects{
        "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + digits(points.x) + " " + digits(points.y) +
            "] /Contents 4 0 R /Resources << /Font << /F1 5 0 R >> >> >>",
        "<< /Length " + std::to_string(content.size()) + " >>\nstream\n" + content + "endstream",
        "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>",
        "<< /Title (" + wordsOf(board) + ") >>"};
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

} // namespace lumorph
