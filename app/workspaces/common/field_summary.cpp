#include "app/workspaces/common/field_summary.h"

#include <algorithm>
#include <cmath>

#include <QLocale>
#include <QObject>

namespace lumorph::studio {
namespace {

constexpr double kRampErrorAim = 0.02;
constexpr double kUncoveredAim = 0.01;

QString tr(const char* text) { return QObject::tr(text); }

QString shareText(double share) {
    const double percent = 100.0 * share;
    return percent > 0.0 && percent < 0.005 ? tr("below 0.01 %")
                                            : tr("%1 %").arg(percent, 0, 'f', percent < 10 ? 2 : 0);
}

QString errorText(double error) {
    return error > 0.0 && error < 0.001 ? QStringLiteral("< 0.001") : QString::number(error, 'f', 3);
}

QString dimensionsText(const glm::ivec3& d) { return tr("%1 × %2 × %3").arg(d.x).arg(d.y).arg(d.z); }

/// Covered at a level but not at a higher one: share of all that were looked at, as R10 is measured.
double uncoveredShare(const Field& field) {
    const double looked = static_cast<double>(field.report.changedVoxels) * field.samples * field.levels;
    return looked > 0.0 ? static_cast<double>(field.report.monotonicityViolations) / looked : 0.0;
}

QString samplesText(const Field& field) {
    return field.exhaustive ? tr("all %1 joint states").arg(countText(field.samples))
                            : tr("%1 joint states (seed %2)").arg(countText(field.samples)).arg(field.seed);
}

QString sizeText(const Field& field, const std::filesystem::path& file) {
    const QString memory = tr("%1 in memory").arg(bytesText(bytesOf(field)));
    std::error_code error;
    const std::uintmax_t disk = file.empty() ? 0 : std::filesystem::file_size(file, error);
    return file.empty() || error ? memory : tr("%1, %2 on disk").arg(memory, bytesText(disk));
}

std::vector<QString> warningsOf(const Field& field) {
    std::vector<QString> warnings;
    if (field.report.rampErrorMean > kRampErrorAim)
        warnings.push_back(tr("The stored ramps are far from what was sampled. Match refined instead of by voting, or "
                              "build with more levels."));
    if (uncoveredShare(field) > kUncoveredAim)
        warnings.push_back(tr("Some space is left free again at higher levels, which the field cannot say. Match "
                              "refined instead of by voting."));
    return warnings;
}

} // namespace

FieldSummary summaryOf(const Field& field, const std::filesystem::path& file, std::optional<double> seconds) {
    const std::size_t outside = field.frame.voxelCount() - field.body.count();
    const double reachable =
        outside == 0 ? 0.0 : static_cast<double>(reachableVoxels(field).count()) / static_cast<double>(outside);
    FieldSummary summary;
    summary.facts = {
        {tr("Space"), tr("%1 voxels").arg(dimensionsText(field.frame.dimensions)),
         tr("The box around everything the device can reach, divided into cubes")},
        {tr("Voxel"), tr("%1 mm").arg(1000.0 * field.frame.voxelSize, 0, 'f', 2), tr("The side of one cube")},
        {tr("Within reach"), tr("%1 of %2 voxels").arg(shareText(reachable), countText(field.frame.voxelCount())),
         tr("Voxels outside the resting device that at least one actuator can fill")},
        {tr("Levels"), tr("%1 for each of %2 actuators").arg(field.levels).arg(field.actuators.size()),
         tr("Steps from rest to full stroke")},
        {tr("Averaged over"), samplesText(field),
         tr("States of the other actuators that the expectation is taken over")},
        {tr("Ramp error"),
         tr("%1 mean, %2 most").arg(errorText(field.report.rampErrorMean), errorText(field.report.rampErrorMax)),
         tr("How far the stored ramps are from the sampled coverage, where 1 is fully covered")},
        {tr("Uncovered again"), shareText(uncoveredShare(field)),
         tr("Space that is filled at a level and free again at a higher one")},
        {tr("Size"), sizeText(field, file), {}},
    };
    if (seconds) summary.facts.push_back({tr("Built in"), tr("%1 s").arg(*seconds, 0, 'f', 1), {}});
    summary.warnings = warningsOf(field);
    return summary;
}

QString countText(std::uint64_t count) {
    if (count >= 1'000'000) return tr("%1 million").arg(static_cast<double>(count) / 1e6, 0, 'f', 1);
    return QLocale(QLocale::English).toString(static_cast<qulonglong>(count));
}

QString bytesText(std::uint64_t bytes) {
    return QLocale(QLocale::English).formattedDataSize(static_cast<qint64>(bytes), 1, QLocale::DataSizeSIFormat);
}

std::uint64_t bytesOf(const Field& field) {
    std::uint64_t bytes = field.background.size() + field.rigGlb.size() + field.body.words().size_bytes();
    for (const ActuatorField& actuator : field.actuators)
        bytes += actuator.runs.size() * sizeof(ActuatorField::Run) + actuator.ramps.size() * sizeof(Ramp);
    return bytes;
}

BuildEstimate estimateOf(const Rig& rig, const BuildOptions& options, const Field* known) {
    BuildEstimate estimate;
    estimate.frame = frameOf(rig.reach(), options.resolution);
    const auto voxels = static_cast<double>(estimate.frame.voxelCount());
    if (known == nullptr) {
        // An actuator changes about a third of the space of a usual rig, its neighbours overlapping it.
        const double changed = voxels * std::min<double>(static_cast<double>(rig.actuatorCount()), 3.0) / 3.0;
        estimate.bytes = static_cast<std::uint64_t>(1.2 * voxels + sizeof(Ramp) * changed);
        return estimate;
    }
    const double finer = voxels / static_cast<double>(known->frame.voxelCount());
    estimate.bytes = static_cast<std::uint64_t>(finer * static_cast<double>(bytesOf(*known)));
    estimate.work = finer * options.levels / known->levels * options.samples / std::max(1U, known->samples);
    return estimate;
}

} // namespace lumorph::studio
