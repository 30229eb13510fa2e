#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "core/base/clock.h"
#include "core/base/image.h"
#include "core/loop/pose_stream.h"

namespace lumorph {

/// One body in one frame of a tracker, in the frame `world`.
struct TrackedBody {
    std::int32_t id = 0;
    std::string name; ///< as the tracker calls it, or "body 3"
    bool valid = false;
    Pose pose;
    bool isNumber = true; ///< false: it was told as seen, with a pose that is none
};

struct TrackerFrame {
    std::uint64_t number = 0; ///< the tracker's own
    Microseconds measured{0}; ///< by our clock: when cameras saw it, as well as that is known
    Microseconds arrived{0};
    std::vector<TrackedBody> bodies;
};

/// What a tracker that is a camera looks at; helps whoever holds a board into its picture.
struct TrackerCamera {
    glm::ivec2 size{0}; ///< of its pictures, pixels
    double picturesPerSecond = 0.0;
    double foundShare = 0.0;                 ///< of the last hundred pictures
    std::optional<double> reprojectionError; ///< pixels, in the newest picture; empty where the board is not in it
    std::string lens;                        ///< what its lens and place are taken for; a sentence
    std::shared_ptr<const Image> preview;    ///< a small picture, with what was found drawn into it; null at first
};

/// What arrives, from whom and how fast; and why nothing does.
struct TrackerStatus {
    std::string source;     ///< "Motive 2.1 at 192.168.0.5, NatNet 3.0"; empty while nothing is known
    std::string address;    ///< URI
    bool verified = true;   ///< false: this version was never seen from real software
    bool receiving = false; ///< a good packet in the last second
    double packetsPerSecond = 0.0;
    double framesPerSecond = 0.0;
    std::uint64_t packets = 0;
    std::uint64_t rejected = 0;                  ///< packets that were wrong
    std::string lastRejected;                    ///< what was wrong with the last of them
    std::optional<double> latencyMilliseconds;   ///< from the cameras' exposure to here, where clocks are matched
    std::vector<TrackedBody> bodies;             ///< newest of each
    std::string advice;                          ///< why nothing comes or counts, and what to do; else empty
    std::string event;                           ///< "head jumped by 3.00 m": what was odd about poses, the newest
    std::uint64_t events = 0;                    ///< ever
    std::shared_ptr<const TrackerCamera> camera; ///< null for what is no camera
};

/// Whether a tracker is simulated, in the studio or by `lumorph-table`: by its address, and as what it names itself.
[[nodiscard]] constexpr bool isSimulatedTracker(std::string_view uri, std::string_view source) noexcept {
    return uri.starts_with("sim://") || source.starts_with("Lumorph table");
}

/// A source of poses, in a thread of its own. Everything may be called from any thread.
class Tracker {
public:
    virtual ~Tracker() = default;
    [[nodiscard]] virtual TrackerStatus status() const = 0;
};

struct TrackerOptions {
    std::shared_ptr<const Clock> clock = std::make_shared<SteadyClock>();
    std::function<void(const TrackerFrame&)> onFrame; ///< in the tracker's thread; must return at once
    /// False: sockets are on loopback, and only what this machine sends is taken, whatever the address says.
    bool openToNetwork = false;
};

/// Opens `natnet://HOST?mode=unicast|multicast&data=1511&command=1510&local=ADDR&multicast=239.255.42.99`,
/// `opentrack://127.0.0.1:4242`, `osc://127.0.0.1:9000` or `sim://head?noise=..&drop=..&latency=..` (the mouse or a
/// path moves it). Throws InvalidInput for an address that is none, DeviceError where a port cannot be bound (who has
/// it, as far as can be told).
[[nodiscard]] std::unique_ptr<Tracker> openTracker(std::string_view uri, TrackerOptions options);

} // namespace lumorph
