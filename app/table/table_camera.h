#pragma once

#include <memory>
#include <mutex>

#include <opencv2/core.hpp>

#include "app/table/screen_eye.h"
#include "app/table/table.h"

namespace lumorph::table {

/// How a camera of the table takes pictures.
struct TableCameraOptions {
    double usualSeconds = 0.01; ///< with which white paper under full white of all projectors comes to `white`
    double white = 200.0;       ///< grey level
    double ambient = 0.02;      ///< the room's light, as a share of the brightest projector's
    double vignetting = 0.15;   ///< of the light, lost in the corners
    double blur = 0.5;          ///< standard deviation, pixels
    double noise = 0.7;         ///< standard deviation of grey, levels
    double shotNoise = 0.008;   ///< variance that each level of grey adds
};

/// A camera that looks at the table by the lab's rays, while projectors throw what the screens show. Light comes
/// `predictionSeconds` of the truth after its picture was on the screen. The way from projector to camera pixel is
/// worked out once while nothing moves; what moves is shown late by the time its rays take, about half a second for
/// 1280 x 1024 pixels.
class TableCamera {
public:
    /// Both outlive it.
    TableCamera(const Table& table, const ScreenEye& eye, std::size_t camera, const TableCameraOptions& options = {});
    ~TableCamera();

    /// 8-bit grey, linear; exposed for so many seconds until it is given back. Any thread, one at a time.
    [[nodiscard]] cv::Mat1b photograph(double exposureSeconds, double gainDecibels = 0.0);
    [[nodiscard]] cv::Size size() const;

    /// Automatic exposure: the brightness of pictures converges to a mean grey, whatever exposure is set.
    void setSetsExposure(bool does);
    /// Night light: the projectors' pictures have 72 % of their green and 45 % of their blue.
    void setSeesNightLight(bool does);

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::table
