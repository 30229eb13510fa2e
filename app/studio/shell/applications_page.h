#pragma once

#include <functional>
#include <string>
#include <vector>

#include <QAbstractButton>
#include <QMouseEvent>
#include <QScrollArea>

#include "app/studio/shell/overlay.h"
#include "app/studio/shell/studio.h"

class QGridLayout;
class QLabel;
class QPushButton;

namespace lumorph {
struct Demo;
}

namespace lumorph::studio {

/// A card for each demonstration that the registry knows, with its picture and one sentence; a click starts it. It lies
/// over the window but for the bar at the top.
class ApplicationsPage : public Overlay {
    Q_OBJECT
public:
    enum class For { host, visitors };
    using Offered = std::function<bool(const Demo& demo)>;
    /// Visitors have cards of those that are offered, a host of all. `studio` outlives it.
    ApplicationsPage(Studio& studio, QWidget& window, For whom, const Offered& offered);

signals:
    void chosen(const lumorph::Demo& demo);
    void tourWanted();
    void studioWanted();
    void workWanted(const std::string& id); ///< kept work is to be brought back
    void backWanted();                      ///< to what shows

protected:
    void arrange() override;
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override { event->accept(); }

private:
    void addCards(const Offered& offered);
    void addOptions(QAbstractButton& card, const Demo& demo);
    void addKeptWork();
    void showKeptWork();
    void addFoot(For whom);
    QPushButton* addFootButton(const char* name, const Words& words);
    void say();

    struct Said {
        QAbstractButton* button;
        Words words;
    };
    Studio& studio_;
    For whom_;
    QLabel *heading_, *about_ = nullptr;
    QWidget* kept_ = nullptr; ///< for the host, while there is kept work
    QLabel* keptName_ = nullptr;
    QPushButton* keptAll_ = nullptr;
    QScrollArea* area_ = nullptr;
    QGridLayout* grid_ = nullptr;
    QWidget* foot_ = nullptr;
    std::vector<QAbstractButton*> cards_;
    std::vector<Said> said_;
};

} // namespace lumorph::studio
