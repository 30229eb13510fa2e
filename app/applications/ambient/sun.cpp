#include "app/applications/ambient/sun.h"

#include <cmath>
#include <numbers>

#include <libnova/aberration.h>
#include <libnova/dynamical_time.h>
#include <libnova/ln_types.h>
#include <libnova/lunar.h>
#include <libnova/nutation.h>
#include <libnova/precession.h>
#include <libnova/solar.h>
#include <libnova/transform.h>

namespace lumorph::ambient {
namespace {

constexpr double kSecondsADay = 86'400.0;
constexpr double kJulianOf1970 = 2'440'587.5;
constexpr double kRadiansADegree = std::numbers::pi / 180.0;
constexpr double kMoonPrecision = 1e-5; ///< radians
constexpr double kEarthRadii = 60.27;   ///< to the moon, in the mean

double julianOf(double utc) { return kJulianOf1970 + utc / kSecondsADay; }

SkyPosition seenFrom(const Place& place, double julian, ln_equ_posn& equatorial) {
    ln_lnlat_posn observer{};
    observer.lat = place.latitude;
    observer.lng = place.longitude;
    ln_hrz_posn horizontal{};
    ln_get_hrz_from_equ(&equatorial, &observer, julian, &horizontal);
    // libnova counts azimuths from south.
    return {std::fmod(horizontal.az + 180.0, 360.0) * kRadiansADegree, horizontal.alt * kRadiansADegree};
}

/// libnova keeps the nutation of a time nearby for the next question; a time shall give the same place whatever was
/// asked before. It begins near the time 0 without any, so one far from all others is asked before that.
void forgetOtherTimes() {
    ln_nutation nutation{};
    ln_get_nutation(1e6, &nutation);
    ln_get_nutation(0.0, &nutation);
}

/// Where the sun crosses the horizon between two times, one of which is before and one after.
double crossing(const Place& place, double from, double to) {
    const bool up = sunAt(place, from).elevation < kHorizon;
    for (int k = 0; k < 12; ++k) {
        const double middle = 0.5 * (from + to);
        ((sunAt(place, middle).elevation < kHorizon) == up ? from : to) = middle;
    }
    return 0.5 * (from + to);
}

} // namespace

const double kHorizon = -0.833 * kRadiansADegree;

/// libnova 0.16 gives sun and moon for the equinox of 2000, whatever its headers say.
SkyPosition sunAt(const Place& place, double utc) {
    forgetOtherTimes();
    ln_equ_posn of2000{}, ofDate{}, apparent{};
    const double julian = julianOf(utc);
    ln_get_solar_equ_coords(ln_get_jde(julian), &of2000);
    ln_get_equ_prec(&of2000, julian, &ofDate);
    ln_get_equ_aber(&ofDate, julian, &apparent);
    return seenFrom(place, julian, apparent);
}

Moon moonAt(const Place& place, double utc) {
    forgetOtherTimes();
    ln_equ_posn of2000{}, ofDate{};
    const double julian = julianOf(utc);
    ln_get_lunar_equ_coords_prec(ln_get_jde(julian), &of2000, kMoonPrecision);
    ln_get_equ_prec(&of2000, julian, &ofDate);
    Moon moon{seenFrom(place, julian, ofDate), ln_get_lunar_disk(julian)};
    // It is near: from the surface it stands lower than from the middle of the earth.
    moon.position.elevation -= std::cos(moon.position.elevation) / kEarthRadii;
    return moon;
}

SunTimes sunTimes(const Place& place, double midnight) {
    constexpr double kStep = 1800.0;
    SunTimes times;
    bool below = sunAt(place, midnight).elevation < kHorizon;
    for (double t = midnight; t < midnight + kSecondsADay; t += kStep) {
        const bool next = sunAt(place, t + kStep).elevation < kHorizon;
        if (next != below) (next ? times.set : times.rise) = crossing(place, t, t + kStep);
        below = next;
    }
    return times;
}

glm::dvec3 towards(const Place& place, const SkyPosition& position) noexcept {
    const glm::dvec2 level = onDevice(place, position.azimuth) * std::cos(position.elevation);
    return {level.x, std::sin(position.elevation), level.y};
}

} // namespace lumorph::ambient
