#include "calibration/solve/device_calibration.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include <Eigen/Dense>
#include <embree3/rtcore.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <opencv2/calib3d.hpp>

namespace lumorph {

namespace {

constexpr std::size_t kFewestChanges = 4; // raised parts by which a device is placed without a guess
constexpr std::size_t kFewestChangedCells = 12;
constexpr double kChanged = 2.5;          // projector pixels between two codes of one place that is another
constexpr double kMovedFace = 0.002;      // metres
constexpr double kGrazing = 0.12;         // cosine: light that grazes a face more says little
constexpr double kExplained = 10.0;       // projector pixels that an error of a good guess stays below
constexpr std::size_t kFirstPoints = 500; // of a camera and a projector
constexpr std::size_t kLastPoints = 3000;
constexpr double kLeastLightNoise = 0.02;  // pixels, that uncertainties count with
constexpr double kLeastSolveNoise = 0.005; // pixels
constexpr double kSettled = 2e-4;          // of a focal length
constexpr double kDeviceFits = 1.5;        // pixels
constexpr double kFitShare = 0.9;          // of the light that falls on the device
constexpr double kRough = 0.008;           // of a projector's width: a guess that is as far off
constexpr double kHopeless = 0.3;          // likewise: the right one lies far above
constexpr double kSurely = 0.9;            // explained: no other guess is looked at
constexpr double kUnlearnt = 0.7;          // of what was known before: such an observation tells nothing

struct ReleaseEmbree {
    void operator()(RTCDevice device) const noexcept { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const noexcept { rtcReleaseScene(scene); }
};

/// The device in one state, for rays.
class DeviceSurface {
public:
    DeviceSurface(RTCDevice device, TriangleMesh mesh) : mesh_(std::move(mesh)), scene_(rtcNewScene(device)) {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* positions = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh_.positions.size()));
        auto* triangles = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), mesh_.triangles.size()));
        if (positions != nullptr && triangles != nullptr) {
            std::ranges::copy(mesh_.positions, positions);
            std::ranges::copy(mesh_.triangles, triangles);
            rtcCommitGeometry(geometry);
            rtcAttachGeometry(scene_.get(), geometry);
        }
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_.get());
        for (const glm::uvec3& t : mesh_.triangles) {
            const glm::dvec3 a(mesh_.positions[t.x]), b(mesh_.positions[t.y]), c(mesh_.positions[t.z]);
            normals_.push_back(glm::cross(b - a, c - a)); // twice the area long
        }
    }

    /// The face that a ray meets first, or -1.
    [[nodiscard]] int hit(const glm::dvec3& from, const glm::dvec3& way) const {
        RTCRayHit ray{};
        ray.ray.org_x = static_cast<float>(from.x);
        ray.ray.org_y = static_cast<float>(from.y);
        ray.ray.org_z = static_cast<float>(from.z);
        ray.ray.dir_x = static_cast<float>(way.x);
        ray.ray.dir_y = static_cast<float>(way.y);
        ray.ray.dir_z = static_cast<float>(way.z);
        ray.ray.tfar = std::numeric_limits<float>::infinity();
        ray.ray.mask = ~0U;
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene_.get(), &context, &ray);
        return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? -1 : static_cast<int>(ray.hit.primID);
    }

    [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
    [[nodiscard]] const glm::dvec3& normal(std::size_t face) const { return normals_[face]; }
    [[nodiscard]] glm::dvec3 middle(std::size_t face) const {
        const glm::uvec3& t = mesh_.triangles[face];
        return glm::dvec3(mesh_.positions[t.x] + mesh_.positions[t.y] + mesh_.positions[t.z]) / 3.0;
    }

private:
    TriangleMesh mesh_;
    std::vector<glm::dvec3> normals_;
    std::unique_ptr<RTCSceneTy, ReleaseEmbree> scene_;
};

/// One decoded place of a camera's picture.
struct LightCell {
    std::size_t shot = 0;
    ProjectorPoint pixels;
};

/// Light that differs from that of the first shot: a raised part, in camera and projector.
struct ChangedLight {
    std::size_t shot = 0, camera = 0, projector = 0;
    cv::Point2d cameraPixel, projectorPixel; ///< the middles of it
};

/// Points of the device and where they were seen, in how many shots.
struct PointMatches {
    std::vector<cv::Point3d> points;
    std::vector<cv::Point2d> pixels;
    std::set<std::size_t> shots;
};

/// A middle that strays do not move.
cv::Point2d steadyMiddle(const std::vector<cv::Point2d>& points) {
    const auto median = [](std::vector<double> numbers) {
        const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
        std::ranges::nth_element(numbers, middle);
        return *middle;
    };
    std::vector<double> xs, ys, away;
    for (const cv::Point2d& p : points) {
        xs.push_back(p.x);
        ys.push_back(p.y);
    }
    const cv::Point2d centre(median(xs), median(ys));
    for (const cv::Point2d& p : points) away.push_back(cv::norm(p - centre));
    const double reach = 3.0 * median(away) + 1.0;
    cv::Point2d sum(0, 0);
    double count = 0.0;
    for (const cv::Point2d& p : points) {
        if (cv::norm(p - centre) > reach) continue;
        sum += p;
        count += 1.0;
    }
    return count > 0.0 ? (1.0 / count) * sum : centre;
}

glm::dvec3 placeOf(const PoseVector& fromWorld) { return Rigid::exp(fromWorld).inverse().translation; }

/// The other pose by which points that lie nearly in a plane look much the same from afar: its tilt is turned over.
PoseVector turnedOver(const PoseVector& pose, const std::vector<cv::Point3d>& points) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    const auto place = [](const cv::Point3d& p) { return Eigen::Vector3d(p.x, p.y, p.z); };
    for (const cv::Point3d& p : points) middle += place(p) / static_cast<double>(points.size());
    for (const cv::Point3d& p : points) spread += (place(p) - middle) * (place(p) - middle).transpose();
    const Eigen::Vector3d normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
    const auto turnedRound = [](const glm::dvec3& axis) {
        return glm::dmat3(1.0) - 2.0 * glm::outerProduct(axis, axis);
    };
    const glm::dvec3 centre(middle.x(), middle.y(), middle.z());
    const Rigid given = Rigid::exp(pose);
    const glm::dvec3 seen = given * centre;
    const glm::dmat3 other =
        turnedRound(glm::normalize(seen)) * given.rotation * turnedRound({normal.x(), normal.y(), normal.z()});
    return Rigid(other, seen - other * centre).log();
}

/// A rough pose, turned so that it looks where the points' middle was seen.
PoseVector aimed(const PoseVector& pose, const Lens& lens, const PointMatches& matches) {
    glm::dvec3 looks(0.0), shall(0.0);
    const Rigid given = Rigid::exp(pose);
    for (std::size_t i = 0; i < matches.points.size(); ++i) {
        const cv::Point3d& point = matches.points[i];
        looks += glm::normalize(given * glm::dvec3(point.x, point.y, point.z));
        const auto way = directionOfPixel(lens, matches.pixels[i].x, matches.pixels[i].y);
        shall += glm::normalize(glm::dvec3(way[0], way[1], 1.0));
    }
    const glm::dquat turn(glm::normalize(looks), glm::normalize(shall)); // the shortest between both
    return (Rigid(glm::mat3_cast(turn), glm::dvec3(0.0)) * given).log();
}

class DeviceSolver {
public:
    DeviceSolver(const Rig& rig, const std::vector<DeviceShot>& shots, const std::vector<NamedDevice>& cameras,
                 const std::vector<NamedDevice>& projectors, const DeviceSolveOptions& options,
                 const Progress& progress)
        : rig_(rig), shots_(shots), cameras_(cameras), projectors_(projectors), options_(options), progress_(progress),
          embree_(rtcNewDevice(nullptr)) {
        checkInput();
        for (const DeviceShot& shot : shots) surfaces_.emplace_back(embree_.get(), deformed(rig, shot.strokes));
        state_.worldFromBody = {PoseVector{}};
        state_.cameras.resize(cameras.size());
        state_.projectors.resize(projectors.size());
        for (std::size_t c = 0; c < cameras.size(); ++c) state_.cameras[c].lens = firstLens(cameras[c].size, 1.5);
        for (std::size_t p = 0; p < projectors.size(); ++p)
            state_.projectors[p].lens = firstLens(projectors[p].size, 1.8);
        if (options.start) state_ = *options.start;
        state_.worldFromBody = {PoseVector{}};
        const double focal = options.start ? 0.3 : 1.5; // how far off it may be, as a share
        noise_.cameras = knownOf(state_.cameras, cameras, focal, 0.1, 0.1);
        noise_.projectors = knownOf(state_.projectors, projectors, focal, 0.12, 0.7);
        cameraPlaced_.resize(cameras.size());
        projectorPlaced_.resize(projectors.size());
    }

    DeviceCalibration solve() {
        progress_.report(0.02, "looking for what moved");
        findChanges();
        placeFirstPair();
        while (placeNext()) progress_.throwIfCancelled();
        requireAllPlaced();
        refineAll();
        report();
        return std::move(result_);
    }

private:
    static Lens firstLens(cv::Size size, double ratio) {
        return {ratio * size.width, 1.0, 0.5 * (size.width - 1), 0.5 * (size.height - 1), 0, 0, 0, 0, 0};
    }

    /// What is known of any lens: how far principal points lie from the middle, how strongly lenses distort.
    static std::vector<InstallationNoise::Known> knownOf(const std::vector<InstallationState::Device>& devices,
                                                         const std::vector<NamedDevice>& names, double focal,
                                                         double across, double down) {
        std::vector<InstallationNoise::Known> all;
        for (std::size_t i = 0; i < devices.size(); ++i)
            all.push_back({devices[i].lens,
                           {focal * devices[i].lens[kFocalLength], 0.01, across * names[i].size.width,
                            down * names[i].size.height, 0.3, 0.5, 0.004, 0.004, 0.5}});
        return all;
    }

    void checkInput() const {
        const auto fail = [](const std::string& what, const std::string& why, const std::string& remedy) {
            throw InvalidInput(what, why, remedy);
        };
        if (cameras_.empty() || projectors_.empty())
            fail("installation", "a camera and a projector are needed", "capture with at least one of each");
        for (const DeviceShot& shot : shots_) {
            bool agree = shot.light.size() == cameras_.size() && shot.strokes.size() == rig_.actuatorCount();
            for (const auto& ofCamera : shot.light) agree = agree && ofCamera.size() == projectors_.size();
            for (const double stroke : shot.strokes) agree = agree && stroke >= 0.0 && stroke <= 1.0;
            if (!agree)
                fail("shot " + shot.name, "it has not one entry for each camera, projector and actuator",
                     "leave what was not seen empty; strokes are from 0 to 1");
        }
        if (options_.start && (options_.start->cameras.size() != cameras_.size() ||
                               options_.start->projectors.size() != projectors_.size()))
            fail("start", "it has not one entry for each camera and projector", "give all or none");
        if (shots_.size() < 2)
            throw CaptureRefused({Cause::tooFewViews, "", "", "one state of the device tells too little of its shape",
                                  "capture it at rest and with each flap raised"});
    }

    // ---- first guess ----

    /// Cells of the picture whose light is another than in the first shot: there, a part has risen.
    void findChanges() {
        const std::vector<std::vector<LightCell>> none(projectors_.size());
        all_.assign(cameras_.size(), none);
        changed_ = all_;
        for (std::size_t c = 0; c < cameras_.size(); ++c)
            for (std::size_t p = 0; p < projectors_.size(); ++p) {
                std::map<std::pair<long, long>, cv::Point2d> before;
                const auto cell = [](const cv::Point2d& at) {
                    return std::pair(std::lround(2.0 * at.x), std::lround(2.0 * at.y));
                };
                for (const ProjectorPoint& point : shots_[0].light[c][p]) before[cell(point.camera)] = point.projector;
                for (std::size_t s = 0; s < shots_.size(); ++s) {
                    std::vector<cv::Point2d> seen, lit;
                    for (const ProjectorPoint& point : shots_[s].light[c][p]) {
                        all_[c][p].push_back({s, point});
                        const auto was = before.find(cell(point.camera));
                        if (was != before.end() && cv::norm(was->second - point.projector) < kChanged) continue;
                        changed_[c][p].push_back({s, point});
                        seen.push_back(point.camera);
                        lit.push_back(point.projector);
                    }
                    if (seen.size() >= kFewestChangedCells)
                        changes_.push_back({s, c, p, steadyMiddle(seen), steadyMiddle(lit)});
                }
            }
    }

    /// The middle of what moved in a shot, as a camera sees it in a projector's light; before those are placed, from
    /// above.
    [[nodiscard]] cv::Point3d middleOf(const ChangedLight& change) const {
        const DeviceSurface& now = surfaces_[change.shot];
        const glm::dvec3 above(0.0, 10.0, 0.0);
        const glm::dvec3 eye = cameraPlaced_[change.camera] ? placeOf(state_.cameras[change.camera].fromWorld) : above;
        const glm::dvec3 lamp =
            projectorPlaced_[change.projector] ? placeOf(state_.projectors[change.projector].fromWorld) : above;
        glm::dvec3 sum(0.0);
        double weights = 0.0;
        for (std::size_t f = 0; f < now.mesh().triangles.size(); ++f) {
            const glm::dvec3 at = now.middle(f);
            if (glm::distance(at, surfaces_[0].middle(f)) < kMovedFace) continue;
            const double facing = glm::dot(now.normal(f), glm::normalize(eye - at));
            if (facing <= 0.0 || glm::dot(now.normal(f), lamp - at) <= 0.0) continue;
            sum += facing * at;
            weights += facing;
        }
        if (weights > 0.0) sum /= weights;
        return {sum.x, sum.y, sum.z};
    }

    template <typename Take> [[nodiscard]] PointMatches matchesWhere(const Take& take) const {
        PointMatches matches;
        for (const ChangedLight& change : changes_) {
            const std::optional<cv::Point2d> pixel = take(change);
            if (!pixel) continue;
            matches.points.push_back(middleOf(change));
            matches.pixels.push_back(*pixel);
            matches.shots.insert(change.shot);
        }
        return matches;
    }
    [[nodiscard]] PointMatches matchesOfCamera(std::size_t c) const {
        return matchesWhere([c](const ChangedLight& change) {
            return change.camera == c ? std::optional(change.cameraPixel) : std::nullopt;
        });
    }
    [[nodiscard]] PointMatches matchesOfProjector(std::size_t p) const {
        return matchesWhere([p](const ChangedLight& change) {
            return change.projector == p ? std::optional(change.projectorPixel) : std::nullopt;
        });
    }

    /// Lenses and poses by which the middles of raised parts lie where they were seen, and the rough one that was
    /// given.
    [[nodiscard]] std::vector<InstallationState::Device> candidates(const PointMatches& matches, const Lens& first,
                                                                    const PoseVector* given) const {
        std::vector<InstallationState::Device> found;
        const std::vector<double> scales = given != nullptr ? std::vector{1.0} : std::vector{1.0, 2.0, 0.5};
        for (const double scale : scales) {
            if (matches.shots.size() < kFewestChanges) break;
            Lens lens = first;
            lens[kFocalLength] *= scale;
            const cv::Matx33d matrix(lens[kFocalLength], 0, lens[kPrincipalX], 0, lens[kFocalLength] * lens[kAspect],
                                     lens[kPrincipalY], 0, 0, 1);
            cv::Mat turn, way;
            try {
                if (!cv::solvePnP(matches.points, matches.pixels, matrix, cv::noArray(), turn, way, false,
                                  cv::SOLVEPNP_SQPNP))
                    continue;
            } catch (const cv::Exception&) { // parts that moved where nothing can be told from
                continue;
            }
            PoseVector pose;
            for (int i = 0; i < 3; ++i) {
                pose[static_cast<std::size_t>(i)] = turn.at<double>(i);
                pose[3 + static_cast<std::size_t>(i)] = way.at<double>(i);
            }
            found.push_back({lens, pose});
            found.push_back({lens, turnedOver(pose, matches.points)});
        }
        if (given != nullptr) {
            found.push_back({first, *given});
            if (!matches.points.empty()) found.push_back({first, aimed(*given, first, matches)});
        }
        std::erase_if(found, [](const auto& device) { return !(placeOf(device.fromWorld).y > 0.0); }); // from below
        return found;
    }

    [[nodiscard]] std::vector<InstallationState::Device> cameraCandidates(std::size_t c) const {
        return candidates(matchesOfCamera(c), state_.cameras[c].lens,
                          options_.start ? &options_.start->cameras[c].fromWorld : nullptr);
    }
    [[nodiscard]] std::vector<InstallationState::Device> projectorCandidates(std::size_t p) const {
        return candidates(matchesOfProjector(p), state_.projectors[p].lens,
                          options_.start ? &options_.start->projectors[p].fromWorld : nullptr);
    }

    [[nodiscard]] std::size_t lightCount(std::size_t c, std::size_t p) const {
        std::size_t count = 0;
        for (const DeviceShot& shot : shots_) count += shot.light[c][p].size();
        return count;
    }

    [[nodiscard]] static CaptureRefused noGuess(const std::string& names) {
        return CaptureRefused(
            {Cause::tooFewViews, "", "",
             "fewer than four shots show a part that has risen where " + names + " sees or lights it",
             "capture the device at rest and with each flap raised by itself, or give a rough start"});
    }

    void placeFirstPair() {
        std::size_t c = 0, p = 0;
        for (std::size_t i = 0; i < cameras_.size(); ++i)
            for (std::size_t k = 0; k < projectors_.size(); ++k)
                if (lightCount(i, k) > lightCount(c, p)) {
                    c = i;
                    p = k;
                }
        if (lightCount(c, p) == 0)
            throw CaptureRefused({Cause::boardUnlit, "", "", "no camera sees any projector's light",
                                  "check exposure, and that the patterns fall on the device"});
        const InstallationState before = state_;
        double best = -1.0;
        InstallationState found;
        for (const auto& ofCamera : cameraCandidates(c))
            for (const auto& ofProjector : projectorCandidates(p)) {
                if (best > kSurely) break;
                progress_.throwIfCancelled();
                state_ = before;
                state_.cameras[c] = ofCamera;
                state_.projectors[p] = ofProjector;
                approach(c, p, true, true);
                const double explained = explainedShare(c, p);
                if (!(explained > best)) continue;
                best = explained;
                found = state_;
            }
        if (best < 0.0) throw noGuess(cameras_[c].name + " or " + projectors_[p].name);
        if (best < kHopeless) throw unexplained(cameras_[c].name + " and " + projectors_[p].name, best);
        state_ = found;
        cameraPlaced_[c] = projectorPlaced_[p] = true;
        progress_.report(0.4, "placing cameras and projectors");
    }

    /// Places a device by one that stands already and shares the most light with it.
    bool placeNext() {
        std::size_t most = 0, c = 0, p = 0;
        for (std::size_t i = 0; i < cameras_.size(); ++i)
            for (std::size_t k = 0; k < projectors_.size(); ++k)
                if (cameraPlaced_[i] != projectorPlaced_[k] && lightCount(i, k) > most) {
                    most = lightCount(i, k);
                    c = i;
                    p = k;
                }
        if (most == 0) return false;
        const bool isCamera = !cameraPlaced_[c];
        const InstallationState before = state_;
        double best = -1.0;
        InstallationState found;
        for (const auto& candidate : isCamera ? cameraCandidates(c) : projectorCandidates(p)) {
            if (best > kSurely) break;
            progress_.throwIfCancelled();
            state_ = before;
            (isCamera ? state_.cameras[c] : state_.projectors[p]) = candidate;
            approach(c, p, isCamera, !isCamera);
            const double explained = explainedShare(c, p);
            if (!(explained > best)) continue;
            best = explained;
            found = state_;
        }
        cameraPlaced_[c] = projectorPlaced_[p] = true;
        if (best < 0.0) throw noGuess(isCamera ? cameras_[c].name : projectors_[p].name);
        if (best < kHopeless) throw unexplained(isCamera ? cameras_[c].name : projectors_[p].name, best);
        state_ = found;
        return true;
    }

    void requireAllPlaced() const {
        std::string names;
        const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ", ") + name; };
        for (std::size_t c = 0; c < cameras_.size(); ++c)
            if (!cameraPlaced_[c]) add(cameras_[c].name);
        for (std::size_t p = 0; p < projectors_.size(); ++p)
            if (!projectorPlaced_[p]) add(projectors_[p].name);
        if (!names.empty())
            throw CaptureRefused({Cause::disconnected, "", "", names + " share no light with the others",
                                  "let each camera see the light of at least one projector that another sees too"});
    }

    // ---- refinement ----

    /// Where a camera looks with this pixel; unit length, the world's frame.
    static glm::dvec3 rayOf(const InstallationState::Device& camera, const cv::Point2d& pixel) {
        const auto direction = directionOfPixel(camera.lens, pixel.x, pixel.y);
        return glm::normalize(glm::dvec3(direction[0], direction[1], 1.0) * Rigid::exp(camera.fromWorld).rotation);
    }

    /// Some of these cells, spread evenly over all, where the camera's ray meets the device. Returns how many were
    /// looked at.
    std::size_t associate(std::size_t c, std::size_t p, const std::vector<LightCell>& cells, std::size_t most,
                          InstallationObservations& into) const {
        const auto& camera = state_.cameras[c];
        const glm::dvec3 from = placeOf(camera.fromWorld);
        const std::size_t used = std::min(cells.size(), most);
        std::vector<SeenLight> found;
        for (std::size_t i = 0; i < used; ++i) {
            const LightCell& cell = cells[i * cells.size() / used];
            const DeviceSurface& surface = surfaces_[cell.shot];
            const glm::dvec3 along = rayOf(camera, cell.pixels.camera);
            if (!std::isfinite(along.x + along.y + along.z + from.x + from.y + from.z)) continue;
            const int hit = surface.hit(from, along);
            if (hit < 0) continue;
            const auto face = static_cast<std::size_t>(hit);
            const glm::dvec3 normal = glm::normalize(surface.normal(face));
            if (!(-glm::dot(normal, along) > kGrazing)) continue;
            SeenLight seen;
            seen.camera = static_cast<int>(c);
            seen.projector = static_cast<int>(p);
            seen.plane = {{normal.x, normal.y, normal.z}, glm::dot(normal, surface.middle(face))};
            seen.pixels = cell.pixels;
            found.push_back(seen);
        }
        const auto errors = errorsOf(found, state_);
        for (std::size_t i = 0; i < found.size(); ++i)
            if (errors[i]) into.lights.push_back(found[i]);
        return used;
    }

    /// How well a guess explains the light: what has changed must lie on the device and be lit by the right pixels, and
    /// so must whatever else lies on the device. 1 is perfect.
    [[nodiscard]] double explainedShare(std::size_t c, std::size_t p) const {
        const auto explained = [this](const InstallationObservations& seen) {
            double sum = 0.0;
            for (const auto& error : errorsOf(seen.lights, state_))
                if (error) sum += std::max(0.0, 1.0 - cv::norm(*error) / kExplained);
            return sum;
        };
        InstallationObservations moved, any;
        const std::size_t asked = associate(c, p, changed_[c][p], kFirstPoints, moved);
        (void)associate(c, p, all_[c][p], kFirstPoints, any);
        if (asked == 0 || any.lights.empty()) return 0.0;
        return explained(moved) / static_cast<double>(asked) * explained(any) / static_cast<double>(any.lights.size());
    }

    static LensMask maskOf(bool principal, bool distortion) {
        LensMask mask{};
        mask[kFocalLength] = true;
        mask[kPrincipalX] = mask[kPrincipalY] = principal;
        mask[kK1] = mask[kK2] = mask[kP1] = mask[kP2] = distortion;
        return mask;
    }

    /// From a rough pose, ever more exactly: the light of one camera and one projector, either of which may move.
    void approach(std::size_t c, std::size_t p, bool moveCamera, bool moveProjector) {
        InstallationNoise noise = noise_;
        noise.robust = 1.0;
        for (double sigma = 0.03 * projectors_[p].size.width; sigma > 0.5; sigma *= 0.6) {
            // What has changed is surely on the device; the rest may be the table, and has its say once that fits.
            const bool rough = sigma > kRough * projectors_[p].size.width;
            InstallationObservations seen;
            (void)associate(c, p, changed_[c][p], kFirstPoints, seen);
            if (!rough) (void)associate(c, p, all_[c][p], kFirstPoints, seen);
            if (seen.lights.size() < 30) return;
            InstallationFree free;
            free.cameras.resize(cameras_.size());
            free.projectors.resize(projectors_.size());
            const LensMask mask = maskOf(!rough, false);
            if (moveCamera) free.cameras[c] = {mask, true};
            if (moveProjector) free.projectors[p] = {mask, true};
            noise.projector = sigma;
            refineInstallation(seen, free, noise, state_, 6);
        }
    }

    /// Robust standard deviation of a coordinate, over light that has an error.
    [[nodiscard]] double noiseOf(const InstallationObservations& seen) const {
        std::vector<double> lengths;
        for (const auto& error : errorsOf(seen.lights, state_))
            if (error) lengths.push_back(cv::norm(*error));
        if (lengths.empty()) return std::numeric_limits<double>::infinity();
        const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
        std::ranges::nth_element(lengths, middle);
        return *middle / 1.1774; // the median length of two normal coordinates of deviation 1
    }

    /// The cells that lie on the device as it is believed to stand now: most of a picture may be table.
    [[nodiscard]] std::vector<LightCell> onDevice(std::size_t c, std::size_t p) const {
        std::vector<LightCell> cells;
        InstallationObservations one;
        for (const LightCell& cell : all_[c][p]) {
            one.lights.clear();
            (void)associate(c, p, {cell}, 1, one);
            if (!one.lights.empty()) cells.push_back(cell);
        }
        return cells;
    }

    void gatherAll(std::size_t most, bool anew) {
        if (anew) onDevice_.assign(cameras_.size(), std::vector<std::vector<LightCell>>(projectors_.size()));
        seen_.lights.clear();
        for (std::size_t c = 0; c < cameras_.size(); ++c)
            for (std::size_t p = 0; p < projectors_.size(); ++p) {
                if (anew) onDevice_[c][p] = onDevice(c, p);
                (void)associate(c, p, onDevice_[c][p], most, seen_);
                // What has risen is little of the light, and all that tells distances from focal lengths.
                (void)associate(c, p, changed_[c][p], most, seen_);
            }
    }

    void refineAll() {
        free_.cameras.assign(cameras_.size(), {maskOf(true, false), true});
        free_.projectors.assign(projectors_.size(), {maskOf(true, false), true});
        constexpr int kWithoutDistortion = 4, kBefore = 6; // rounds
        constexpr int kMostRounds = 20;
        constexpr int kRoughSteps = 10, kSteps = 60; // from afar a small device tells focal length from distance only
                                                     // in a long valley
        for (int round = 0; round < kMostRounds; ++round) {
            progress_.throwIfCancelled();
            progress_.report(0.6 + 0.36 * round / kMostRounds, "solving for all together");
            if (round == kWithoutDistortion) {
                free_.cameras.assign(cameras_.size(), {maskOf(true, true), true});
                free_.projectors.assign(projectors_.size(), {maskOf(true, true), true});
            }
            const bool isRough = round < kBefore;
            gatherAll(isRough ? kFirstPoints : kLastPoints, round == 0 || round == kBefore);
            noise_.projector = std::max(kLeastSolveNoise, noiseOf(seen_));
            noise_.robust = 3.0;
            if (!std::isfinite(noise_.projector)) throw misfit("no projector lights it where a camera sees light");
            const InstallationState before = state_;
            refineInstallation(seen_, free_, noise_, state_, isRough ? kRoughSteps : kSteps);
            if (round > kBefore && isSettled(before)) break;
        }
        noise_.projector = std::max(kLeastLightNoise, noiseOf(seen_));
        progress_.report(0.97, "uncertainties");
        result_.sigma = installationSigmas(seen_, free_, noise_, state_);
    }

    /// Whether no focal length moves any more.
    [[nodiscard]] bool isSettled(const InstallationState& before) const {
        const auto rests = [](const std::vector<InstallationState::Device>& now,
                              const std::vector<InstallationState::Device>& then) {
            for (std::size_t i = 0; i < now.size(); ++i)
                if (std::abs(now[i].lens[kFocalLength] / then[i].lens[kFocalLength] - 1.0) > kSettled) return false;
            return true;
        };
        return rests(state_.cameras, before.cameras) && rests(state_.projectors, before.projectors);
    }

    /// `what`: which of the light contradicts the device's shape, and by how much.
    [[nodiscard]] static CaptureRefused misfit(const std::string& what) {
        return CaptureRefused({Cause::modelDoesNotFit, "", "", "the light does not fit the device's shape: " + what,
                               "check that the rig is this device, that its flaps stand as they were told, and that "
                               "neither it nor cameras and projectors moved"});
    }

    [[nodiscard]] static CaptureRefused unexplained(const std::string& devices, double share) {
        return misfit("where " + devices + " fits best, it explains " +
                      std::to_string(static_cast<int>(100.0 * share)) + " of 100 lit points");
    }

    void requireFit() {
        std::vector<double> beside;
        for (const auto& error : errorsOf(seen_.lights, state_))
            if (error) beside.push_back(cv::norm(*error));
        const auto others = std::partition(beside.begin(), beside.end(),
                                           [this](double pixels) { return pixels < 5.0 * noise_.projector; });
        const auto fits = static_cast<double>(others - beside.begin());
        result_.rms = noise_.projector;
        result_.onDevice = fits / std::max<double>(1.0, static_cast<double>(seen_.lights.size()));
        char text[160];
        if (result_.rms > kDeviceFits) {
            std::snprintf(text, sizeof(text), "%.1f projector pixels remain", result_.rms);
            throw misfit(text);
        }
        if (result_.onDevice >= kFitShare) return;
        std::string by;
        if (const auto left = beside.end() - others; left > 0) {
            const auto middle = others + left / 2;
            std::nth_element(others, middle, beside.end());
            std::snprintf(text, sizeof(text), ", the others lie %.1f projector pixels beside it (median)", *middle);
            by = text;
        }
        std::snprintf(text, sizeof(text), "%.0f of 100 lit points lie on it as it was told to stand",
                      std::floor(100.0 * result_.onDevice));
        throw misfit(text + by);
    }

    void report() {
        requireFit();
        const auto take = [this](const NamedDevice& named, const InstallationState::Device& solved,
                                 const InstallationState::Device& sigma, const InstallationNoise::Known& known,
                                 const LensMask& free) {
            CalibratedDevice device;
            device.size = named.size;
            device.lens = solved.lens;
            device.sigma = sigma.lens;
            device.free = free;
            device.model = "k1 k2 p1 p2";
            device.rms = result_.rms;
            std::string held;
            constexpr const char* kNames[] = {"f", "aspect", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
            for (std::size_t i = 0; i < free.size(); ++i) {
                if (!free[i] || sigma.lens[i] < kUnlearnt * known.sigma[i]) continue;
                device.free[i] = false;
                held += (held.empty() ? "" : ", ") + std::string(kNames[i]);
            }
            if (!held.empty())
                result_.warnings.push_back(
                    {Cause::undetermined, "", "",
                     "the light cannot tell " + held + " of " + named.name + ", which was held near the usual",
                     "capture more states of the device"});
            return device;
        };
        for (std::size_t c = 0; c < cameras_.size(); ++c)
            result_.cameras.push_back(take(cameras_[c], state_.cameras[c], result_.sigma.cameras[c], noise_.cameras[c],
                                           free_.cameras[c].lens));
        for (std::size_t p = 0; p < projectors_.size(); ++p)
            result_.projectors.push_back(take(projectors_[p], state_.projectors[p], result_.sigma.projectors[p],
                                              noise_.projectors[p], free_.projectors[p].lens));
        result_.state = state_;
    }

    const Rig& rig_;
    const std::vector<DeviceShot>& shots_;
    const std::vector<NamedDevice>&cameras_, &projectors_;
    const DeviceSolveOptions& options_;
    const Progress& progress_;
    std::unique_ptr<RTCDeviceTy, ReleaseEmbree> embree_;
    std::vector<DeviceSurface> surfaces_;                            ///< one a shot
    std::vector<std::vector<std::vector<LightCell>>> all_, changed_; ///< by camera and projector
    std::vector<std::vector<std::vector<LightCell>>> onDevice_;      ///< of `all_`
    std::vector<ChangedLight> changes_;
    std::vector<bool> cameraPlaced_, projectorPlaced_;
    InstallationNoise noise_;
    InstallationFree free_;
    InstallationState state_;
    InstallationObservations seen_;
    DeviceCalibration result_;
};

} // namespace

std::vector<ProjectorPoint> lightOf(const DecodedView& view, int most) {
    const double right = view.column.cols - 1;
    const double bottom = view.column.rows - 1;
    return projectorPointsOn(view, {{0.0, 0.0}, {right, 0.0}, {right, bottom}, {0.0, bottom}}, most);
}

DeviceCalibration calibrateOnDevice(const Rig& rig, const std::vector<DeviceShot>& shots,
                                    const std::vector<NamedDevice>& cameras, const std::vector<NamedDevice>& projectors,
                                    const DeviceSolveOptions& options, const Progress& progress) {
    return DeviceSolver(rig, shots, cameras, projectors, options, progress).solve();
}

} // namespace lumorph
