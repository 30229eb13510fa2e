#pragma once

#include <memory>
#include <vector>

#include <QAbstractTableModel>

#include "app/studio/widgets/plot.h"
#include "core/loop/match_frame.h"

namespace lumorph::studio {

/// What a match says for each actuator: its name, and its level ("9 → 6" where refinement moved it off its vote), or
/// that the target is out of its reach.
class VoteModel : public QAbstractTableModel {
    Q_OBJECT
public:
    enum Column { nameColumn, levelColumn, columnCountOf };

    using QAbstractTableModel::QAbstractTableModel;
    void setFrame(std::shared_ptr<const MatchFrame> frame);

    [[nodiscard]] int rowCount(const QModelIndex& parent = {}) const override;
    [[nodiscard]] int columnCount(const QModelIndex& parent = {}) const override;
    [[nodiscard]] QVariant data(const QModelIndex& index, int role) const override;
    [[nodiscard]] QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

private:
    [[nodiscard]] QString levelText(std::size_t actuator) const;
    [[nodiscard]] bool missed(std::size_t actuator) const;
    std::shared_ptr<const MatchFrame> frame_;
};

/// The error |V~ - V_T| / (V~ . V_T) of one actuator at each level (Eq. 1). A gap where no level counts, or where the
/// error is so far above the best that it would flatten the curve.
[[nodiscard]] std::vector<double> errorCurve(const ActuatorVote& vote);

} // namespace lumorph::studio
