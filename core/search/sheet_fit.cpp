#include "core/search/sheet_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/voxels/solid.h"

namespace lumorph {
namespace {

constexpr double kCell = 0.25; ///< millimetres between places of a profile that are worked out

constexpr double kOverfill = 0.8;

/// Where a bending sheet's upper surface lies over a place at distance u from the bend line.
struct ProfilePlace {
    float length = 0.0F; ///< of sheet from the line to there, millimetres
    float height = 0.0F; ///< above the sheet at rest, millimetres
};

/// What one flap adds at each level: voxels covered, and of them those that each target wants.
struct FlapGains {
    std::vector<std::int32_t> covered; ///< one a level
    std::vector<std::int32_t> both;    ///< [level][target]
};

/// Depth of a flap at w along its line: the largest u of its rim there.
class RimDepth {
public:
    explicit RimDepth(const std::vector<glm::dvec2>& rim) : rim_(rim) {}
    [[nodiscard]] double at(double w) const {
        double depth = 0.0;
        for (std::size_t k = 0; k + 1 < rim_.size(); ++k) {
            const glm::dvec2& a = rim_[k];
            const glm::dvec2& b = rim_[k + 1];
            if (w < a.x || w > b.x || b.x - a.x < 1e-9) continue;
            depth = std::max(depth, a.y + (b.y - a.y) * (w - a.x) / (b.x - a.x));
        }
        return depth;
    }

private:
    const std::vector<glm::dvec2>& rim_;
};

} // namespace

struct SheetFit::Tables {
    VoxelFrame frame;
    int levels = 0;
    std::size_t targets = 0;
    std::vector<std::int32_t> wanted; ///< voxels of each target
    /// [column][voxels counted from the sheet up][target]: how many of them the target wants.
    std::vector<std::uint8_t> below;
    std::vector<ProfilePlace> profile; ///< [level][place]
    std::size_t places = 0;

    void drawProfiles(double arc, double thickness, double angle, double longest);
    void countTarget(std::size_t target, const BitColumns& bits);
    [[nodiscard]] FlapGains gainsOf(const Flap& flap) const;
    [[nodiscard]] std::vector<FlapGains> gainsOf(const std::vector<Flap>& flaps) const;
    void addColumn(std::size_t column, double u, double depth, FlapGains& gains) const;
    [[nodiscard]] double mostWon(const FlapGains& flap, std::size_t target) const;
    [[nodiscard]] double bestRatio(const std::vector<FlapGains>& flaps, std::size_t target) const;
};

/// The upper side lies half the thickness above the neutral surface: an arc of a smaller radius.
void SheetFit::Tables::drawProfiles(double arc, double thickness, double angle, double longest) {
    places = static_cast<std::size_t>(longest / kCell) + 2;
    profile.assign(static_cast<std::size_t>(levels) * places, {});
    for (int level = 0; level < levels; ++level) {
        const double turned = angle * level / (levels - 1);
        for (std::size_t place = 0; place < places; ++place) {
            const double u = kCell * static_cast<double>(place);
            ProfilePlace& at = profile[static_cast<std::size_t>(level) * places + place];
            if (level == 0) {
                at = {static_cast<float>(u), 0.0F};
                continue;
            }
            const double radius = arc / turned;
            const double upper = radius - 0.5 * thickness;
            const double end = upper * std::sin(turned);
            if (u <= end) {
                const double share = std::asin(u / upper);
                at = {static_cast<float>(radius * share),
                      static_cast<float>(upper - std::sqrt(std::max(0.0, upper * upper - u * u)))};
            } else {
                const double beyond = (u - end) / std::max(1e-6, std::cos(turned));
                at = {static_cast<float>(std::min(1e6, arc + beyond)),
                      static_cast<float>(upper * (1.0 - std::cos(turned)) + std::min(1e6, beyond) * std::sin(turned))};
            }
        }
    }
}

void SheetFit::Tables::countTarget(std::size_t target, const BitColumns& bits) {
    const auto height = static_cast<std::size_t>(frame.dimensions.y);
    for (int z = 0; z < frame.dimensions.z; ++z)
        for (int x = 0; x < frame.dimensions.x; ++x) {
            std::uint8_t count = 0;
            for (std::size_t y = 0; y < height; ++y) {
                count = static_cast<std::uint8_t>(count + (bits.test(x, static_cast<int>(y), z) ? 1 : 0));
                below[(bits.columnIndex(x, z) * (height + 1) + y + 1) * targets + target] = count;
            }
            wanted[target] += count;
        }
}

/// Adds what the flap covers in one column at each level. Beyond the frame's top nothing is wanted.
void SheetFit::Tables::addColumn(std::size_t column, double u, double depth, FlapGains& gains) const {
    const auto height = static_cast<int>(frame.dimensions.y);
    const double perVoxel = 1.0 / (1e3 * frame.voxelSize);
    const std::size_t place = std::min(places - 1, static_cast<std::size_t>(std::lround(u / kCell)));
    const std::uint8_t* const counts = &below[column * static_cast<std::size_t>(height + 1) * targets];
    double highest = 0.0;
    bool passed = false;
    for (int level = 1; level < levels; ++level) {
        if (!passed) {
            const ProfilePlace& before = profile[static_cast<std::size_t>(level - 1) * places + place];
            const ProfilePlace& now = profile[static_cast<std::size_t>(level) * places + place];
            const auto at = static_cast<double>(now.length);
            passed = at > depth; // the rim went by between the two levels
            const double share = passed ? std::clamp((depth - static_cast<double>(before.length)) /
                                                         std::max(1e-9, at - static_cast<double>(before.length)),
                                                     0.0, 1.0)
                                        : 1.0;
            highest = std::max(highest, static_cast<double>(before.height) +
                                            share * static_cast<double>(now.height - before.height));
        }
        const int covered = static_cast<int>(std::lround(highest * perVoxel));
        if (covered == 0) continue;
        gains.covered[static_cast<std::size_t>(level)] += covered;
        const std::uint8_t* const of = counts + static_cast<std::size_t>(std::min(covered, height)) * targets;
        std::int32_t* const both = &gains.both[static_cast<std::size_t>(level) * targets];
        for (std::size_t t = 0; t < targets; ++t) both[t] += of[t];
    }
}

FlapGains SheetFit::Tables::gainsOf(const Flap& flap) const {
    FlapGains gains{std::vector<std::int32_t>(static_cast<std::size_t>(levels), 0),
                    std::vector<std::int32_t>(static_cast<std::size_t>(levels) * targets, 0)};
    glm::dvec2 low = flap.outline.front();
    glm::dvec2 high = low;
    for (const glm::dvec2& p : flap.outline) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const RimDepth rim(flap.rim);
    const double step = 1e3 * frame.voxelSize;
    const glm::dvec2 corner(1e3 * static_cast<double>(frame.origin.x), 1e3 * static_cast<double>(frame.origin.z));
    const auto first = [&](double at, double from) {
        return std::max(0, static_cast<int>(std::ceil((at - from) / step - 0.5)));
    };
    const int x1 = std::min(frame.dimensions.x - 1.0, std::floor((high.x - corner.x) / step - 0.5));
    const int z1 = std::min(frame.dimensions.z - 1.0, std::floor((-low.y - corner.y) / step - 0.5));
    for (int z = first(-high.y, corner.y); z <= z1; ++z)
        for (int x = first(low.x, corner.x); x <= x1; ++x) {
            const glm::dvec2 local = flap.frame.local({corner.x + (x + 0.5) * step, -(corner.y + (z + 0.5) * step)});
            if (local.y <= 0.0) continue;
            const double depth = rim.at(local.x);
            if (local.y <= depth)
                addColumn(static_cast<std::size_t>(z) * static_cast<std::size_t>(frame.dimensions.x) +
                              static_cast<std::size_t>(x),
                          local.y, depth, gains);
        }
    return gains;
}

std::vector<FlapGains> SheetFit::Tables::gainsOf(const std::vector<Flap>& flaps) const {
    std::vector<FlapGains> gains;
    gains.reserve(flaps.size());
    for (const Flap& flap : flaps) gains.push_back(gainsOf(flap));
    return gains;
}

/// Voxels won less kOverfill of those overfilled, at the best level.
double SheetFit::Tables::mostWon(const FlapGains& flap, std::size_t target) const {
    double most = 0.0;
    for (std::size_t level = 1; level < flap.covered.size(); ++level) {
        const double both = flap.both[level * targets + target];
        most = std::max(most, both - kOverfill * (flap.covered[level] - both));
    }
    return most;
}

/// The largest both / either over all joint states, by Dinkelbach's iteration.
double SheetFit::Tables::bestRatio(const std::vector<FlapGains>& flaps, std::size_t target) const {
    double ratio = 0.0;
    for (;;) {
        double both = 0.0;
        double either = wanted[target];
        for (const FlapGains& flap : flaps) {
            double most = 0.0;
            double addBoth = 0.0;
            double addEither = 0.0;
            for (std::size_t level = 1; level < flap.covered.size(); ++level) {
                const double inBoth = flap.both[level * targets + target];
                const double inEither = flap.covered[level] - inBoth;
                const double worth = inBoth - ratio * inEither;
                if (worth <= most) continue;
                most = worth;
                addBoth = inBoth;
                addEither = inEither;
            }
            both += addBoth;
            either += addEither;
        }
        const double reached = either > 0.0 ? both / either : 0.0;
        if (reached <= ratio) return ratio;
        ratio = reached;
    }
}

SheetFit::SheetFit(const SheetDevice& sheet, Angle angle, std::span<const Target> targets, const Options& options,
                   const Progress& progress) {
    auto tables = std::make_unique<Tables>();
    const double top = sheet.housing + kSheetAboveHousing + sheet.thickness;
    Box box;
    for (const glm::dvec2& p : sheet.outline) box.include(glm::vec3(p.x, top, p.y));
    const glm::dvec3 size(box.size());
    double highest = top;
    for (const Target& target : targets) {
        const Box of = boundingBox(target.mesh.positions);
        highest = std::max(highest, static_cast<double>(of.max.y));
        box.include(glm::vec3(of.min.x, top, of.min.z));
        box.include(glm::vec3(of.max.x, top, of.max.z));
    }
    constexpr int kMostHigh = 250; // voxels are counted in a byte
    VoxelFrame& frame = tables->frame;
    frame.voxelSize = std::max(std::max(size.x, size.z) / options.columns, (highest - top) / kMostHigh);
    frame.origin = glm::vec3(box.min.x, static_cast<float>(top), box.min.z);
    const glm::dvec3 room = glm::dvec3(box.size()) / frame.voxelSize;
    frame.dimensions = {static_cast<int>(std::ceil(room.x - 1e-6)),
                        std::max(1, static_cast<int>(std::ceil((highest - top) / frame.voxelSize - 1e-6))),
                        static_cast<int>(std::ceil(room.z - 1e-6))};
    if (targets.empty() || highest <= top || !fitsLimits(frame.dimensions))
        throw InvalidInput("targets", "none stands above the sheet, or one is far too large",
                           "place them on the device, or let them be fitted");
    tables->levels = options.levels;
    tables->targets = targets.size();
    tables->wanted.assign(targets.size(), 0);
    tables->below.assign(static_cast<std::size_t>(frame.dimensions.x) * static_cast<std::size_t>(frame.dimensions.z) *
                             (static_cast<std::size_t>(frame.dimensions.y) + 1) * targets.size(),
                         0);
    tables->drawProfiles(1e3 * sheet.arc, 1e3 * sheet.thickness, angle.inRadians(), 1e3 * std::hypot(size.x, size.z));
    SolidVoxelizer voxelizer;
    BitColumns bits;
    for (std::size_t t = 0; t < targets.size(); ++t) {
        progress.throwIfCancelled();
        voxelizeTarget(frame, targets[t], voxelizer, bits, progress.part(0.0, 0.0));
        tables->countTarget(t, bits);
    }
    tables_ = std::move(tables);
}

SheetFit::~SheetFit() = default;
SheetFit::SheetFit(SheetFit&&) noexcept = default;

std::vector<double> SheetFit::each(const std::vector<Flap>& flaps) const {
    const std::vector<FlapGains> gains = tables_->gainsOf(flaps);
    std::vector<double> fits;
    for (std::size_t t = 0; t < tables_->targets; ++t) fits.push_back(tables_->bestRatio(gains, t));
    return fits;
}

SheetFit::Worth SheetFit::of(const std::vector<Flap>& flaps) const {
    const std::vector<FlapGains> gains = tables_->gainsOf(flaps);
    Worth worth;
    for (std::size_t t = 0; t < tables_->targets; ++t) {
        worth.fit += tables_->bestRatio(gains, t);
        double won = 0.0;
        for (const FlapGains& flap : gains) won += tables_->mostWon(flap, t);
        worth.gain += won / std::max(1, tables_->wanted[t]);
    }
    worth.fit /= static_cast<double>(tables_->targets);
    worth.gain /= static_cast<double>(tables_->targets);
    return worth;
}

} // namespace lumorph
