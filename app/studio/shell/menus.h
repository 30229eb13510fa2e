#pragma once

#include <map>

#include <QMenuBar>

#include "app/studio/shell/studio.h"

class QMenu;

namespace lumorph::studio {

/// The menus of the bar, filled from the studio's commands as these come. What a workspace brings is in sight while
/// that workspace is, and its keys sleep otherwise; a menu without a command in sight is hidden.
class Menus : public QObject {
    Q_OBJECT
public:
    /// Commands become actions of `window`, so that their keys work while any part of it has the keyboard.
    Menus(Studio& studio, QMenuBar& bar, QWidget& window);

    void show(const QString& workspace);
    /// No menu and no key at all, or all again.
    void setShut(bool shut);

private:
    void join(QAction* action);
    void fill(const QString& name);
    void follow();

    Studio& studio_;
    QWidget& window_;
    std::map<QString, QMenu*> menus_;
    QMenu* recent_ = nullptr;
    QString workspace_;
    bool shut_ = false;
};

} // namespace lumorph::studio
