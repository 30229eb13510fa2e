#pragma once

#include <vector>

#include <QComboBox>
#include <QFrame>
#include <QGridLayout>
#include <QLabel>
#include <QVBoxLayout>

#include "app/studio/devices/tracker_service.h"
#include "app/studio/widgets/plot.h"
#include "app/workspaces/devices/camera_panel.h"
#include "app/workspaces/devices/simulated_panel.h"

namespace lumorph::studio {

/// One open tracker: from whom it hears, how fast, what is wrong, which bodies it sees and who they are in the show.
class TrackerCard : public QFrame {
public:
    /// Its parts are named "NAME.source", "NAME.close" and so on.
    TrackerCard(TrackerService& service, const QString& address, const QString& name, QWidget* parent = nullptr);
    void show(const OpenTracker& tracker);
    [[nodiscard]] const QString& address() const noexcept { return address_; }

private:
    struct BodyRow {
        QWidget* widget = nullptr;
        QLabel* name = nullptr;
        QLabel* place = nullptr;
        QComboBox* role = nullptr;
    };

    [[nodiscard]] QLabel* addText(const QString& part, const char* look);
    [[nodiscard]] QLabel* addFact(QGridLayout& grid, int row, int column, const QString& label, const QString& part,
                                  const QString& tip);
    void addHead();
    void addFacts();
    void addBodyRow();
    void showBodies(const TrackerStatus& status);
    void showSource(const OpenTracker& tracker);
    [[nodiscard]] Plot* addPlot(const QString& part, const QString& what, const QString& unit);

    TrackerService& service_;
    QString address_, name_;
    QVBoxLayout* layout_;
    QLabel *source_ = nullptr, *unproven_ = nullptr, *advice_ = nullptr, *reason_ = nullptr, *event_ = nullptr,
           *more_ = nullptr;
    QLabel *frames_ = nullptr, *packets_ = nullptr, *rejected_ = nullptr, *latency_ = nullptr;
    QVBoxLayout* bodies_ = nullptr;
    int sourceRow_ = 0; ///< where in the layout what only some trackers have comes
    std::vector<BodyRow> rows_;
    std::vector<std::string> shown_;      ///< names of the bodies in the rows
    CameraPanel* camera_ = nullptr;       ///< of a camera, made when it is known to be one
    SimulatedPanel* simulated_ = nullptr; ///< the same of a simulated tracker
    Plot *rate_ = nullptr, *delay_ = nullptr;
};

} // namespace lumorph::studio
