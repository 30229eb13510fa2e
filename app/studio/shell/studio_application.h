#pragma once

#include <exception>
#include <functional>

#include <QApplication>

namespace lumorph::studio {

/// An application that outlives its mistakes: what is thrown while an event is handled is told instead of ending the
/// program.
class StudioApplication : public QApplication {
    Q_OBJECT
public:
    StudioApplication(int& argc, char** argv);

    /// Who is told; on stderr while there is nobody.
    void setOnError(std::function<void(const std::exception&)> told);

    bool notify(QObject* receiver, QEvent* event) override;

private:
    void tell(const std::exception& error);

    std::function<void(const std::exception&)> told_;
};

/// Prepares everything that has to be set before the application is made. Returns why no window can be shown here, with
/// the remedy; empty when all is well.
[[nodiscard]] QString prepareApplication(int argc, char** argv);

} // namespace lumorph::studio
