#include "app/workspaces/rig/device_fit.h"

#include <algorithm>

#include <QStringList>

#include "app/studio/widgets/dock_parts.h"
#include "app/workspaces/rig/rig_facts.h"

namespace lumorph::studio {
namespace {

/// Never broken between number and sign.
QString wholeShare(double share) { return shareText(share).replace(' ', QChar::Nbsp); }

} // namespace

DeviceFit fitDevice(const Rig& rig, std::span<const LibraryTarget> library, const LibraryFitOptions& options,
                    const Progress& progress) {
    LibraryMatcher matcher(rig, library, options, progress.part(0.0, 0.4));
    DeviceFit result;
    result.fit = matcher.fit(progress.part(0.4, 0.95));
    BitColumns covered;
    CoverageScratch scratch;
    for (std::size_t t = 0; t < result.fit.targets.size(); ++t) {
        progress.throwIfCancelled();
        matcher.coverage().covered(result.fit.targets[t].state, covered, scratch);
        result.reliefs.push_back(reliefOf(matcher.coverage().body(), matcher.voxelsOf(t), covered));
    }
    return result;
}

std::vector<double> strokesOf(const LibraryFit& fit, std::size_t target) {
    std::vector<double> strokes;
    for (const Level level : fit.targets.at(target).state)
        strokes.push_back(static_cast<double>(level.index) / static_cast<double>(fit.levels - 1));
    return strokes;
}

QString targetTitle(const std::string& name) {
    QString title = QString::fromStdString(name).replace('_', ' ');
    if (!title.isEmpty()) title[0] = title[0].toUpper();
    return title;
}

QString fitText(const LibraryFit& fit) {
    const TargetFit& best = fit.targets.at(fit.best);
    const TargetFit& worst = fit.targets.at(fit.worst);
    return QString("Over %1 shapes it fits by %2 on average: best %3 (%4), worst %5 (%6).")
        .arg(fit.targets.size())
        .arg(wholeShare(fit.mean), targetTitle(best.name), wholeShare(best.iou), targetTitle(worst.name),
             wholeShare(worst.iou));
}

QString targetText(const TargetFit& target) {
    const double wanted = static_cast<double>(target.quality.both + target.quality.unmatched);
    const double covered = static_cast<double>(target.quality.both + target.quality.overfilled);
    if (wanted <= 0.0) return QString("%1 lies out of the device's reach.").arg(targetTitle(target.name));
    QString words = QString("%1: %2 fit. %3 of the shape stays unmatched")
                        .arg(targetTitle(target.name), wholeShare(target.iou),
                             wholeShare(static_cast<double>(target.quality.unmatched) / wanted));
    if (covered > 0.0)
        words += QString(", %1 of what the device covers is too much")
                     .arg(wholeShare(static_cast<double>(target.quality.overfilled) / covered));
    words += '.';
    if (target.unreachable >= 0.01)
        words += QString(" No single actuator gets to %1 of it.").arg(wholeShare(target.unreachable));
    return words;
}

QString weakServosText(std::span<const ServoLoad> loads) {
    QStringList names;
    const ServoType* servo = nullptr; // of them all; none where they differ
    bool alike = true;
    double most = 0.0;
    for (const ServoLoad& load : loads) {
        if (!load.weak) continue;
        names << QString::fromStdString(load.actuator);
        alike = alike && (servo == nullptr || servo == load.servo);
        servo = load.servo;
        most = std::max(most, load.torque);
    }
    if (names.isEmpty()) return {};
    constexpr qsizetype kNamed = 3;
    const qsizetype others = names.size() - kNamed;
    QString who = names.mid(0, kNamed).join(", ");
    if (others > 0) who += QString(" and %1 more").arg(others);
    QString words = alike ? QString("Too weak: the %1 of %2 can hold %3 and would need %4. ")
                                .arg(shownText(servo->name), who, torqueText(servo->usableTorque()), torqueText(most))
                          : QString("Too weak: the servos of %1 would need up to %2. ").arg(who, torqueText(most));
    const ServoType* enough = cheapestServo(most);
    return words + (enough ? QString("The cheapest that is strong enough is the %1.").arg(shownText(enough->name))
                           : QString("No servo of the table is strong enough: shorten the lever, or split the flap."));
}

} // namespace lumorph::studio
