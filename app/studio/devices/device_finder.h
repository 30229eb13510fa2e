#pragma once

#include <memory>
#include <vector>

#include <QObject>

#include "devices/transport/discovery.h"

namespace lumorph::studio {

/// What is connected to this machine, looked for every two seconds while somebody wants to know, and what a search of
/// Bluetooth found. Lives in the window's thread; looking is done in others.
class DeviceFinder : public QObject {
    Q_OBJECT
public:
    /// The bench outlives it.
    explicit DeviceFinder(const SimulatedBench& bench);
    /// Waits for a look that is under way, which takes milliseconds, but not for the Bluetooth service.
    ~DeviceFinder() override;

    void setLooking(bool looking);
    [[nodiscard]] const std::vector<FoundDevice>& found() const noexcept;
    void searchBluetooth();
    [[nodiscard]] bool searchingBluetooth() const noexcept;

signals:
    void changed();
    void searchFailed(const lumorph::LinkTrouble& trouble);

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
