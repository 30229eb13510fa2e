#pragma once

#include <set>

#include <QPointer>
#include <QWidget>

#include "app/studio/shell/studio.h"

class QHBoxLayout;
class QLabel;
class QPushButton;

namespace lumorph::studio {

/// The line at the bottom that always says the same four things: project, hardware or virtual lab, loop rate with match
/// time, warnings; and the jobs that run.
class StatusLine : public QWidget {
    Q_OBJECT
public:
    StatusLine(Studio& studio, QWidget* parent);

private:
    void showProject();
    void showHardware();
    void showLoop();
    void showWarnings();
    void listWarnings();

    Studio& studio_;
    std::set<QString> places_; ///< at which notices were seen
    QLabel* project_ = nullptr;
    QLabel* hardware_ = nullptr;
    QLabel* loop_ = nullptr;
    QPushButton* warnings_ = nullptr;
    MatchTimes lastMatch_;
    QPointer<QWidget> list_;
};

} // namespace lumorph::studio
