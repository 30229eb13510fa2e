#pragma once

#include <array>

namespace lumorph {

/// A pinhole with Brown distortion, of a camera or a projector; OpenCV's conventions.
inline constexpr int kLensParameters = 9;
/// Focal length along rows (pixels), aspect (that along columns divided by it), principal point (pixels, the centre of
/// the first at 0), k1, k2, p1, p2, k3.
using Lens = std::array<double, kLensParameters>;
/// Which of them are free to move.
using LensMask = std::array<bool, kLensParameters>;

enum LensParameter { kFocalLength, kAspect, kPrincipalX, kPrincipalY, kK1, kK2, kP1, kP2, kK3 };

/// Distorts a direction (x, y, 1).
template <typename T> void distort(const T* lens, const T& x, const T& y, T& distortedX, T& distortedY) {
    const T r2 = x * x + y * y;
    const T radial = T(1.0) + r2 * (lens[kK1] + r2 * (lens[kK2] + r2 * lens[kK3]));
    distortedX = x * radial + T(2.0) * lens[kP1] * x * y + lens[kP2] * (r2 + T(2.0) * x * x);
    distortedY = y * radial + lens[kP1] * (r2 + T(2.0) * y * y) + T(2.0) * lens[kP2] * x * y;
}

/// The pixel of a point in the lens's frame; its z must not be 0.
template <typename T> void projectPoint(const T* lens, const T* point, T* pixel) {
    T x, y;
    distort<T>(lens, point[0] / point[2], point[1] / point[2], x, y);
    pixel[0] = lens[kPrincipalX] + lens[kFocalLength] * x;
    pixel[1] = lens[kPrincipalY] + lens[kFocalLength] * lens[kAspect] * y;
}

namespace lens_detail {

inline double valueOf(double number) { return number; }
template <typename Jet> double valueOf(const Jet& jet) { return jet.a; }

/// The Jacobian of `distort`, row by row.
std::array<double, 4> distortionJacobian(const Lens& lens, double x, double y);

} // namespace lens_detail

/// The direction (x, y, 1) in which a pixel looks, to 1e-12, within the radius where distortion does not fold back.
std::array<double, 2> directionOfPixel(const Lens& lens, double u, double v);

/// The same for numbers with derivatives: the value by iteration, and one Newton step there, whose derivatives by the
/// lens are exact.
template <typename T> void directionOfPixel(const T* lens, double u, double v, T& x, T& y) {
    Lens values;
    for (int i = 0; i < kLensParameters; ++i) values[static_cast<std::size_t>(i)] = lens_detail::valueOf(lens[i]);
    const auto [x0, y0] = directionOfPixel(values, u, v);
    T distortedX, distortedY;
    distort<T>(lens, T(x0), T(y0), distortedX, distortedY);
    const T offX = distortedX - (T(u) - lens[kPrincipalX]) / lens[kFocalLength];
    const T offY = distortedY - (T(v) - lens[kPrincipalY]) / (lens[kFocalLength] * lens[kAspect]);
    const auto [a, b, c, d] = lens_detail::distortionJacobian(values, x0, y0);
    const double determinant = a * d - b * c;
    x = T(x0) - (T(d) * offX - T(b) * offY) / T(determinant);
    y = T(y0) - (T(a) * offY - T(c) * offX) / T(determinant);
}

} // namespace lumorph
