#pragma once

#include <memory>
#include <optional>

#include <QObject>
#include <QTimer>

#include "app/studio/document/studio_loop.h"
#include "core/loop/match_frame.h"
#include "core/mdf/certify.h"

namespace lumorph::studio {

/// How far the match of a target that stands still is from the best possible, ever tighter while nothing moves: one
/// thread that gives way to others works on it for a while.
class FitCertificate : public QObject {
    Q_OBJECT
public:
    explicit FitCertificate(StudioLoop& loop);
    ~FitCertificate() override;

    /// It rests until somebody can see it.
    void setActive(bool active);
    struct Known {
        Certificate certificate;
        std::optional<double> betweenLevels; ///< the best IoU with strokes between the levels too; at the end
    };
    /// Of the newest frame's target as it stands; empty until the first bound is there.
    [[nodiscard]] const std::optional<Known>& known() const { return known_; }

signals:
    void changed();

private:
    /// What a bound is of. It does not depend on what the servos do.
    struct Question {
        std::shared_ptr<const MatchField> field;
        std::shared_ptr<const MatchTarget> target;
        std::shared_ptr<const std::vector<glm::vec3>> positions;
        glm::mat4 deviceFromTarget{1.0F};
        bool relief = false;
        bool operator==(const Question&) const = default;
    };
    class Worker;
    void look();
    void begin();
    void forget();

    StudioLoop& loop_;
    bool active_ = false;
    QTimer still_; ///< until what stands still counts as at rest
    Question asked_;
    std::optional<Known> known_;
    std::unique_ptr<Worker> worker_;
};

/// Sentences for a match of this IoU, numbers rounded so that they hold; empty where nothing is known.
[[nodiscard]] QString certificateText(const std::optional<FitCertificate::Known>& known, double iou);

} // namespace lumorph::studio
