#pragma once

#include <QLabel>
#include <QWidget>

#include "app/studio/base/settings.h"

namespace lumorph::studio {

/// What visitors see where nothing can be shown: a quiet page that says so, and lies over the view until something can.
class RestPage : public QWidget {
    Q_OBJECT
public:
    /// `settings` outlive it.
    RestPage(Settings& settings, QWidget* parent);

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    void say();

    Settings& settings_;
    QLabel *title_, *sentence_;
};

} // namespace lumorph::studio
