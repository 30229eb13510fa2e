#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "calibration/patterns/capture_order.h"

namespace lumorph::cli {

/// What the images of a capture show, as the arguments say it.
struct PatternArguments {
    std::string pattern = "graycode";
    std::string file; ///< an order file in place of it; empty: none

    void addTo(CLI::App& command) {
        command.add_option("--pattern", pattern, "graycode, or phase:16x3+1x3 (periods x steps)")
            ->capture_default_str();
        command.add_option("--order", file,
                           "In place of --pattern: a file that says, one line an image, what each shows");
    }
    /// Throws InvalidInput; DataError with the file's line.
    [[nodiscard]] CaptureOrder orderFor(cv::Size projector) const {
        return file.empty() ? parsePattern(pattern, projector) : readCaptureOrder(file, projector);
    }
    [[nodiscard]] const std::string& name() const { return file.empty() ? pattern : file; }
};

} // namespace lumorph::cli
