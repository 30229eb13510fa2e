#include "app/workspaces/field/vote_table.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "app/studio/look/palette.h"

namespace lumorph::studio {

namespace {

/// Errors above this many times the best are left out of the curve.
constexpr double kHighest = 6.0;

const ActuatorVote* voteOf(const MatchFrame& frame, std::size_t actuator) {
    if (!frame.votes || actuator >= frame.votes->actuators.size()) return nullptr;
    return &frame.votes->actuators[actuator];
}

} // namespace

void VoteModel::setFrame(std::shared_ptr<const MatchFrame> frame) {
    const bool same = frame_ && frame && frame_->rig == frame->rig;
    if (!same) beginResetModel();
    frame_ = std::move(frame);
    if (!same) return endResetModel();
    if (rowCount() > 0) emit dataChanged(index(0, levelColumn), index(rowCount() - 1, levelColumn));
}

int VoteModel::rowCount(const QModelIndex& parent) const {
    return parent.isValid() || !frame_ || !frame_->rig ? 0 : static_cast<int>(frame_->rig->actuatorCount());
}

int VoteModel::columnCount(const QModelIndex& parent) const { return parent.isValid() ? 0 : columnCountOf; }

bool VoteModel::missed(std::size_t actuator) const {
    const ActuatorVote* vote = frame_->matched ? voteOf(*frame_, actuator) : nullptr;
    return vote && !vote->reached;
}

QString VoteModel::levelText(std::size_t actuator) const {
    if (actuator >= frame_->wanted.size()) return "–";
    const int level = frame_->wanted[actuator].index;
    const ActuatorVote* vote = frame_->matched ? voteOf(*frame_, actuator) : nullptr;
    if (missed(actuator) && level == 0) return "out of reach";
    if (!vote || vote->level.index == level) return QString::number(level);
    return QString("%1 → %2").arg(vote->level.index).arg(level);
}

QVariant VoteModel::data(const QModelIndex& index, int role) const {
    if (!index.isValid() || index.row() >= rowCount()) return {};
    const auto actuator = static_cast<std::size_t>(index.row());
    const bool level = index.column() == levelColumn;
    if (role == Qt::DisplayRole)
        return level ? levelText(actuator) : QString::fromStdString(frame_->rig->actuators()[actuator].name);
    if (role == Qt::TextAlignmentRole && level)
        return QVariant::fromValue(Qt::Alignment(Qt::AlignRight | Qt::AlignVCenter));
    if (role == Qt::ForegroundRole && level && missed(actuator)) return currentPalette().warning;
    if (role == Qt::ToolTipRole && missed(actuator))
        return QString("No level of this actuator covers enough of the target, so Eq. 1 leaves it at rest.");
    return {};
}

QVariant VoteModel::headerData(int section, Qt::Orientation orientation, int role) const {
    if (orientation != Qt::Horizontal || section < 0 || section >= columnCountOf) return {};
    if (role == Qt::DisplayRole) return section == nameColumn ? "Actuator" : "Level";
    if (role == Qt::TextAlignmentRole && section == levelColumn)
        return QVariant::fromValue(Qt::Alignment(Qt::AlignRight | Qt::AlignVCenter));
    if (role == Qt::ToolTipRole && section == levelColumn)
        return "The level it is asked for; with an arrow where refinement moved it off its vote by Eq. 1";
    return {};
}

std::vector<double> errorCurve(const ActuatorVote& vote) {
    const double gap = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> curve(std::min(vote.errors.size(), vote.intersections.size()), gap);
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t level = 0; level < curve.size(); ++level) {
        if (vote.intersections[level] < 1.0) continue;
        curve[level] = vote.errors[level] / vote.intersections[level];
        best = std::min(best, curve[level]);
    }
    for (double& error : curve)
        if (error > kHighest * best) error = gap;
    return curve;
}

} // namespace lumorph::studio
