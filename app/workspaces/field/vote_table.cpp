#include "app/workspaces/field/vote_table.h"

#include <algorithm>
#include <cmath>
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

/// Still on its way by more than half a level.
bool onItsWay(const MatchFrame& frame, std::size_t actuator) {
    if (actuator >= frame.wantedStrokes.size() || actuator >= frame.estimatedStrokes.size()) return false;
    const int levels = frame.field ? frame.field->field.levels : 33;
    return std::abs(frame.wantedStrokes[actuator] - frame.estimatedStrokes[actuator]) > 0.5 / levels;
}

} // namespace

void VoteModel::setFrame(std::shared_ptr<const MatchFrame> frame) {
    const bool same = frame_ && frame && frame_->rig == frame->rig;
    if (!same) beginResetModel();
    frame_ = std::move(frame);
    if (!same) return endResetModel();
    if (rowCount() > 0) emit dataChanged(index(0, votedColumn), index(rowCount() - 1, stateColumn));
}

int VoteModel::rowCount(const QModelIndex& parent) const {
    return parent.isValid() || !frame_ || !frame_->rig ? 0 : static_cast<int>(frame_->rig->actuatorCount());
}

int VoteModel::columnCount(const QModelIndex& parent) const { return parent.isValid() ? 0 : columnCountOf; }

QString VoteModel::textOf(std::size_t actuator, int column) const {
    const ActuatorVote* vote = frame_->matched ? voteOf(*frame_, actuator) : nullptr;
    switch (column) {
    case nameColumn:
        return QString::fromStdString(frame_->rig->actuators()[actuator].name);
    case votedColumn:
        return vote ? QString::number(vote->level.index) : QString("–");
    case levelColumn:
        return actuator < frame_->wanted.size() ? QString::number(frame_->wanted[actuator].index) : QString("–");
    default:
        if (vote && !vote->reached) return "out of reach";
        return onItsWay(*frame_, actuator) ? "moving" : "there";
    }
}

QVariant VoteModel::data(const QModelIndex& index, int role) const {
    if (!index.isValid() || index.row() >= rowCount()) return {};
    const auto actuator = static_cast<std::size_t>(index.row());
    if (role == Qt::DisplayRole) return textOf(actuator, index.column());
    if (role == Qt::TextAlignmentRole && (index.column() == votedColumn || index.column() == levelColumn))
        return QVariant::fromValue(Qt::Alignment(Qt::AlignRight | Qt::AlignVCenter));
    if (role != Qt::ForegroundRole || index.column() == nameColumn || index.column() == levelColumn) return {};
    const ActuatorVote* vote = voteOf(*frame_, actuator);
    const bool missed = index.column() == stateColumn && frame_->matched && vote && !vote->reached;
    return missed ? currentPalette().warning : currentPalette().textMuted;
}

QVariant VoteModel::headerData(int section, Qt::Orientation orientation, int role) const {
    if (orientation != Qt::Horizontal) return {};
    static const char* const names[] = {"Actuator", "Voted", "Level", ""};
    static const char* const hints[] = {"", "The level that Eq. 1 gives this actuator on its own",
                                        "The level it is asked for, refined where that is on", "Whether it is there"};
    if (role == Qt::DisplayRole && section >= 0 && section < columnCountOf) return QString(names[section]);
    if (role == Qt::ToolTipRole && section >= 0 && section < columnCountOf) return QString(hints[section]);
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
