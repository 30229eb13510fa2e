#pragma once

#include <string>

#include <QAbstractButton>
#include <QApplication>

#include "tests/ui/studio_window.h"

namespace lumorph::test {

/// A hand on the whole chain of a calibration, in the Calibrate workspace.
class ChainHand {
public:
    explicit ChainHand(StudioWindow& window) : window_(window) {}

    void open() {
        window_.window().showWorkspace("calibrate");
        window_.click("calibrate.whole");
    }
    [[nodiscard]] QString badge(const QString& link) { return window_.text("chain.link." + link + ".how"); }
    [[nodiscard]] QString button() {
        const auto* next = window_.findNow<QAbstractButton>("chain.card.next");
        return next ? next->text() : QString();
    }
    [[nodiscard]] bool offers(const QString& words) {
        return eventually([&] { return button() == words; }, std::chrono::seconds(120));
    }
    /// The card's button, and no double click with the one before.
    void next() {
        pass(std::chrono::milliseconds(QApplication::doubleClickInterval() + 50));
        window_.click("chain.card.next");
    }
    [[nodiscard]] const Installation& room() { return *window_.state().installation; }
    [[nodiscard]] std::string story() {
        return (window_.text("chain.card.title") + ": " + window_.text("chain.card.text")).toStdString();
    }

private:
    StudioWindow& window_;
};

} // namespace lumorph::test
