#pragma once

#include <optional>

#include <QObject>
#include <glm/vec3.hpp>

namespace lumorph::studio {

/// What of the field and the match the Field workspace shows; not part of the document, no undo.
struct FieldDisplay {
    enum class Show { nothing, voxels, surface };
    Show show = Show::nothing;
    std::optional<int> actuator; ///< empty: all combined
    int surfaceLevel = 16;       ///< of the level surface
    int lowestLevel = 0;         ///< voxels first covered at these levels
    int highestLevel = 255;
    glm::ivec3 sliceFrom{0}; ///< box of voxels, both ends included
    glm::ivec3 sliceTo{0x7FFF};
    bool touchedOnly = false; ///< only voxels that the target touches
    bool showTarget = true;
    bool showMismatch = true;        ///< unmatched and overfilled volume in colour
    bool showWish = false;           ///< a ghost of the device where it is asked to be
    std::optional<glm::ivec3> voxel; ///< whose ramps are plotted
    bool operator==(const FieldDisplay&) const = default;
};

class FieldDisplayModel : public QObject {
    Q_OBJECT
public:
    using QObject::QObject;
    [[nodiscard]] const FieldDisplay& value() const noexcept { return value_; }
    void set(const FieldDisplay& value) {
        if (value == value_) return;
        value_ = value;
        emit changed();
    }

signals:
    void changed();

private:
    FieldDisplay value_;
};

} // namespace lumorph::studio
