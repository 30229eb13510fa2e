#include "calibration/solve/lens_model.h"

#include <cmath>

namespace lumorph {

namespace lens_detail {

std::array<double, 4> distortionJacobian(const Lens& lens, double x, double y) {
    const double r2 = x * x + y * y;
    const double radial = 1.0 + r2 * (lens[kK1] + r2 * (lens[kK2] + r2 * lens[kK3]));
    const double slope = lens[kK1] + r2 * (2.0 * lens[kK2] + r2 * 3.0 * lens[kK3]); // of `radial` by r2
    const double mixed = 2.0 * (x * y * slope + lens[kP1] * x + lens[kP2] * y);
    return {radial + 2.0 * x * x * slope + 2.0 * lens[kP1] * y + 6.0 * lens[kP2] * x, mixed, mixed,
            radial + 2.0 * y * y * slope + 6.0 * lens[kP1] * y + 2.0 * lens[kP2] * x};
}

} // namespace lens_detail

std::array<double, 2> directionOfPixel(const Lens& lens, double u, double v) {
    constexpr int kMostSteps = 30;
    const double wantedX = (u - lens[kPrincipalX]) / lens[kFocalLength];
    const double wantedY = (v - lens[kPrincipalY]) / (lens[kFocalLength] * lens[kAspect]);
    double x = wantedX;
    double y = wantedY;
    for (int step = 0; step < kMostSteps; ++step) {
        double distortedX = 0.0;
        double distortedY = 0.0;
        distort(lens.data(), x, y, distortedX, distortedY);
        const auto [a, b, c, d] = lens_detail::distortionJacobian(lens, x, y);
        const double determinant = a * d - b * c;
        if (std::abs(determinant) < 1e-9) break;
        const double offX = distortedX - wantedX;
        const double offY = distortedY - wantedY;
        x -= (d * offX - b * offY) / determinant;
        y -= (a * offY - c * offX) / determinant;
        if (std::abs(offX) + std::abs(offY) < 1e-13) break;
    }
    return {x, y};
}

} // namespace lumorph
