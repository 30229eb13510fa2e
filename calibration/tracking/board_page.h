#pragma once

#include <string>

#include "calibration/decode/calibration_board.h"
#include "calibration/tracking/board_finder.h"

namespace lumorph {

/// A page to print, as PDF: the board at its true size in the middle of a sheet of A4 or A3 (lying where that suits,
/// larger where it must be), with its measures and a line of 100 mm to check the print by. Throws as checkBoard.
[[nodiscard]] std::string boardPdf(const MarkerBoard& board);
/// The same of a board to calibrate with, its lengths in millimetres.
[[nodiscard]] std::string calibrationBoardPdf(const CalibrationBoard& board);

/// What the page says of the board: "ChArUco, 5 x 7 squares of 30 mm, markers of 22 mm, dictionary 4X4_50".
[[nodiscard]] std::string wordsOf(const MarkerBoard& board);

/// The part of an address after the question mark that tells this board: "squares=5x7&size=30&..".
[[nodiscard]] std::string queryOf(const MarkerBoard& board);

} // namespace lumorph
