#include <algorithm>
#include <array>

#include <QLabel>
#include <QVBoxLayout>

#include "app/studio/look/palette.h"
#include "app/studio/widgets/plot.h"
#include "app/workspaces/field/field_show.h"
#include "core/mdf/field_view.h"

namespace lumorph::studio {
namespace {

constexpr std::size_t kMaxCurves = 8;

/// Colours that are told apart by hue and by lightness, for dark and for light panels.
QColor curveColor(std::size_t index) {
    static constexpr std::array<std::array<QRgb, kMaxCurves>, 2> kColors{{
        {0xFF4FC3D9, 0xFFF2A65A, 0xFF8BD17C, 0xFFE58BB7, 0xFFB39DF2, 0xFFE8D96B, 0xFFEF7F72, 0xFFB9C2CC},
        {0xFF08798F, 0xFFB35A00, 0xFF2E7D32, 0xFFAD2E6E, 0xFF5E42B8, 0xFF7A6A00, 0xFFB3362B, 0xFF566270},
    }};
    return QColor::fromRgb(kColors[currentTheme() == Theme::dark ? 0 : 1][index % kMaxCurves]);
}

class VoxelRamps : public QWidget {
public:
    VoxelRamps(Studio& studio, FieldDisplayModel& display)
        : studio_(studio), display_(display), where_(new QLabel), plot_(new Plot) {
        where_->setObjectName("field.voxel");
        where_->setWordWrap(true);
        where_->setProperty("look", "muted");
        plot_->setObjectName("field.ramps");
        plot_->setAccessibleName(tr("Ramps of a voxel"));
        plot_->setAxes(tr("level"), tr("expected coverage"));
        plot_->setRange(0.0, 1.0);
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        layout->addWidget(where_);
        layout->addWidget(plot_);
        connect(&display_, &FieldDisplayModel::changed, this, [this] { refresh(); });
        connect(&studio_.document, &StudioDocument::changed, this, [this](StateParts parts) {
            if (parts & StatePart::field) refresh();
        });
        connect(&studio_.settings, &Settings::themeChanged, this, [this] {
            shown_.reset();
            refresh();
        });
        refresh();
    }

private:
    /// What the curves come from; they are worked out again only when it changes.
    struct Shown {
        const MatchField* field = nullptr;
        std::optional<glm::ivec3> voxel;
        bool clickable = false;
        bool operator==(const Shown&) const = default;
    };

    void refresh() {
        const auto& field = studio_.document.state().field.field;
        const FieldDisplay& value = display_.value();
        const Shown now{field.get(), value.voxel, value.show == FieldDisplay::Show::voxels};
        if (shown_ == now) return;
        shown_ = now;
        plot_->setEmptyText(now.clickable ? tr("Click a voxel to see its ramps")
                                          : tr("Show voxels, then click one to see its ramps"));
        plot_->setCurves({});
        where_->hide();
        if (field && value.voxel && inside(field->field.frame, *value.voxel)) showVoxel(field->field, *value.voxel);
    }

    static bool inside(const VoxelFrame& frame, const glm::ivec3& voxel) {
        return glm::all(glm::greaterThanEqual(voxel, glm::ivec3(0))) &&
               glm::all(glm::lessThan(voxel, frame.dimensions));
    }

    void showVoxel(const Field& field, const glm::ivec3& voxel) {
        const std::vector<std::vector<double>> ramps = rampsAt(field, voxel);
        std::vector<std::size_t> changing;
        for (std::size_t i = 0; i < ramps.size(); ++i)
            if (ramps[i].back() != ramps[i].front()) changing.push_back(i);
        const auto rise = [&](std::size_t i) { return ramps[i].back() - ramps[i].front(); };
        std::stable_sort(changing.begin(), changing.end(),
                         [&](std::size_t a, std::size_t b) { return rise(a) > rise(b); });
        std::vector<Plot::Curve> curves;
        for (const std::size_t i : changing) {
            if (curves.size() == kMaxCurves) break;
            curves.push_back({QString::fromStdString(field.actuators[i].name), curveColor(curves.size()), ramps[i]});
        }
        where_->setText(textOf(field, voxel, changing.size()));
        where_->show();
        if (curves.empty()) plot_->setEmptyText(tr("No actuator changes this voxel"));
        plot_->setCurves(std::move(curves));
    }

    static QString textOf(const Field& field, const glm::ivec3& voxel, std::size_t changing) {
        const glm::dvec3 centre = 100.0 * field.frame.centre(voxel.x, voxel.y, voxel.z);
        QString text = tr("Voxel %1, %2, %3 at x %4, y %5, z %6 cm.")
                           .arg(voxel.x)
                           .arg(voxel.y)
                           .arg(voxel.z)
                           .arg(centre.x, 0, 'f', 1)
                           .arg(centre.y, 0, 'f', 1)
                           .arg(centre.z, 0, 'f', 1);
        if (changing > kMaxCurves) text += tr(" %1 actuators change it; those that do most are shown.").arg(changing);
        return text;
    }

    Studio& studio_;
    FieldDisplayModel& display_;
    QLabel* where_;
    Plot* plot_;
    std::optional<Shown> shown_;
};

} // namespace

QWidget* makeVoxelRamps(Studio& studio, FieldDisplayModel& display) { return new VoxelRamps(studio, display); }

} // namespace lumorph::studio
