#include "app/studio/viewport/camera_motion.h"

#include <cmath>

namespace lumorph::studio {
namespace {

// Half of a zoom is done after this time.
constexpr double kZoomHalfLife = 0.028;
// What is left of a zoom that no eye sees.
constexpr double kZoomRest = 0.002;

double seconds(CameraMotion::Time from, CameraMotion::Time to) {
    return std::chrono::duration<double>(to - from).count();
}

// Starts and ends gently.
double eased(double t) { return t * t * (3.0 - 2.0 * t); }

} // namespace

ViewCamera CameraMotion::destination() const {
    if (glide_) return glide_->to;
    return zoom_ ? zoomed(camera_, std::exp(zoom_->remaining), zoom_->pixel, zoom_->size) : camera_;
}

void CameraMotion::set(const ViewCamera& camera) {
    camera_ = camera;
    glide_.reset();
    zoom_.reset();
}

void CameraMotion::glideTo(const ViewCamera& target, Time now) {
    zoom_.reset();
    glide_ = Glide{camera_, target, now};
}

void CameraMotion::zoomBy(double factor, glm::vec2 pixel, glm::vec2 size, Time now) {
    glide_.reset();
    if (!zoom_) zoom_ = Zoom{.last = now};
    zoom_->remaining += std::log(factor);
    zoom_->pixel = pixel;
    zoom_->size = size;
}

void CameraMotion::advance(Time now) {
    if (glide_) {
        const double t = seconds(glide_->begun, now) / std::chrono::duration<double>(kGlide).count();
        camera_ = t >= 1.0 ? glide_->to : between(glide_->from, glide_->to, eased(t));
        if (t >= 1.0) glide_.reset();
    }
    if (zoom_) {
        const double left = zoom_->remaining * std::exp2(-seconds(zoom_->last, now) / kZoomHalfLife);
        const bool ends = std::abs(left) < kZoomRest;
        camera_ = zoomed(camera_, std::exp(zoom_->remaining - (ends ? 0.0 : left)), zoom_->pixel, zoom_->size);
        zoom_->remaining = left;
        zoom_->last = now;
        if (ends) zoom_.reset();
    }
}

} // namespace lumorph::studio
