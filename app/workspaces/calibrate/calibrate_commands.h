#pragma once

#include <filesystem>

#include "app/workspaces/calibrate/calibrate_docks.h"

namespace lumorph::studio {

/// Whether there is a result that one more pose could make better.
[[nodiscard]] bool offersAnother(const CalibrationState& state);

/// Of the card with the next step; empty: there is none.
[[nodiscard]] QString buttonOf(const CalibrationState& state);

void addCalibrateCommands(const CalibrateParts& parts);

/// Calibrates from the images in this folder.
void useFolder(CalibrationService& service, Settings& settings, const std::filesystem::path& folder);
/// Asks for it.
void askForImages(const CalibrateParts& parts);
/// Asks for a file that says what each image of a folder shows.
void askForOrder(const CalibrateParts& parts);
/// Asks for a recording of a link of the chain.
void askForRecording(const CalibrateParts& parts, std::size_t link, std::size_t file);
/// Asks for a folder in which what devices said of a link is kept.
void askToKeepRecording(const CalibrateParts& parts, std::size_t link);
/// Asks where poses are saved.
void askForSaved(const CalibrateParts& parts);
/// Asks for a folder and exports the patterns to it, as pictures and as a film.
void askToWritePatterns(const CalibrateParts& parts);
/// Where to write the page of the board that is set up.
void askToPrintBoard(const CalibrateParts& parts);

} // namespace lumorph::studio
