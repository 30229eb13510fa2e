#pragma once

#include <memory>

#include <QWidget>

namespace lumorph::studio {

/// Whether anything of a window can be seen. It cannot while the window is minimised or on another desktop, or, under
/// X11 without a compositor, while other windows cover all of it. A compositor does not report what covers a window;
/// there only a full-screen window of this program counts, while it was the last one active.
class SightWatch : public QObject {
    Q_OBJECT
public:
    explicit SightWatch(QWidget& window);
    ~SightWatch() override;

    /// True until the window has been shown.
    [[nodiscard]] bool seen() const noexcept;

signals:
    void changed();

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
