#pragma once

#include <functional>
#include <optional>

#include <QComboBox>
#include <QLineEdit>
#include <QPushButton>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "app/studio/widgets/segments.h"
#include "app/studio/widgets/value_field.h"
#include "core/rig/templates/sheet_device.h"

namespace lumorph::studio {

/// The numbers and names of a drawing: of one bend line while it is chosen, else of the sheet. It shows a drawing and
/// says what would become of it; whoever owns the drawing gives it back by `show`.
class SheetForm : public QStackedWidget {
    Q_OBJECT
public:
    explicit SheetForm(QWidget* parent = nullptr);

    void show(const SheetDevice& device, std::optional<std::size_t> line);

signals:
    void previewed(const lumorph::SheetDevice& device);
    void edited(const lumorph::SheetDevice& device, const QString& step);
    void reverted();
    void otherSideWanted();
    void removeWanted();

private:
    using Edit = std::function<void(SheetDevice&, double)>;
    struct Words {
        const char* name;
        QString label;
        QString hint;
        QString step; ///< of undo
    };
    struct Limits {
        Quantity quantity;
        double low, high, reset;
    };
    ValueField* addField(QVBoxLayout& column, const Words& words, const Limits& limits, const Edit& edit);
    QLineEdit* addName(QVBoxLayout& column, const char* name, const QString& hint);
    QWidget* makeSheet();
    QWidget* makeLine();
    void rename();
    void setEnds(BendLine::Ends ends);
    void change(const QString& step, const std::function<void(SheetDevice&)>& edit);
    [[nodiscard]] BendLine* lineOf(SheetDevice& device) const;

    SheetDevice device_;
    std::optional<std::size_t> line_;
    QLineEdit* name_ = nullptr; ///< of the device
    Segments* top_ = nullptr;
    QComboBox* material_ = nullptr;
    QWidget *materialRow_ = nullptr, *arcRow_ = nullptr, *endsRow_ = nullptr; ///< of one kind of top each
    ValueField *width_ = nullptr, *depth_ = nullptr, *thickness_ = nullptr, *housing_ = nullptr, *arc_ = nullptr;
    QLineEdit* lineName_ = nullptr;
    ValueField* angle_ = nullptr;
    QPushButton *joined_ = nullptr, *free_ = nullptr;
};

} // namespace lumorph::studio
