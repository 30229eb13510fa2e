#pragma once

#include <optional>

#include <QObject>

namespace lumorph::studio {

/// Which servo the Devices workspace points at; not part of the document, no undo.
class ServoSelection : public QObject {
    Q_OBJECT
public:
    using QObject::QObject;
    [[nodiscard]] std::optional<std::size_t> servo() const noexcept { return servo_; }
    void select(std::optional<std::size_t> servo) {
        if (servo == servo_) return;
        servo_ = servo;
        emit changed();
    }
    /// The servo that wiggles while its user shall click the row of the one that moved.
    [[nodiscard]] std::optional<std::size_t> assigning() const noexcept { return assigning_; }
    void assign(std::optional<std::size_t> servo) {
        if (servo == assigning_) return;
        assigning_ = servo;
        emit assigningChanged();
    }

signals:
    void changed();
    void assigningChanged();

private:
    std::optional<std::size_t> servo_;
    std::optional<std::size_t> assigning_;
};

} // namespace lumorph::studio
