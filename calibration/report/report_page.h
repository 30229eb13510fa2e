#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/decode/refusal.h"
#include "calibration/report/calibration_record.h"
#include "calibration/solve/observations.h"

namespace lumorph {

/// A picture in a report; 8-bit grey or BGR.
struct ReportPicture {
    std::string title;
    cv::Mat picture;
};

/// What a report tells of.
struct CalibrationReport {
    CalibrationRecord record;
    /// What the figures were made of, by the record's views; without them residuals are not drawn.
    std::vector<ViewObservations> observations;
    std::vector<cv::Mat> sights;         ///< a picture of each of those views, 8-bit grey; may be empty
    std::vector<ReportPicture> pictures; ///< whatever else is to be seen, such as a map of errors
    std::optional<Finding> refusal;      ///< the capture was refused: there are no figures
    /// Light lands no farther beside, in 95 of 100 cases, millimetres; `where`: "where the device stands". Empty: the
    /// figure of its boards, where the record has one.
    std::optional<double> millimetres;
    std::string where = "on its boards";
};

/// A page of HTML that needs nothing beside it: figures, each view, plots of residuals, warnings and refusals with what
/// to do, inputs and date. Pictures lie in it as data. Simple enough for QTextDocument, which makes a PDF of it. All
/// names are escaped.
[[nodiscard]] std::string reportPage(const CalibrationReport& report);

} // namespace lumorph
