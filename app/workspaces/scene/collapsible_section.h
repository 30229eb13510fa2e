#pragma once

#include <QString>
#include <QToolButton>
#include <QVBoxLayout>
#include <QWidget>

namespace lumorph::studio {

/// A group of rows under a heading that folds away.
class CollapsibleSection : public QWidget {
    Q_OBJECT
public:
    /// `name` is the heading's objectName.
    CollapsibleSection(const QString& name, const QString& title, bool open, QWidget* parent = nullptr);

    [[nodiscard]] QVBoxLayout& rows() noexcept { return *rows_; }
    void setOpen(bool open);
    void setTitle(const QString& title);
    /// Stands at the end of the heading.
    void addToHeading(QWidget* widget);

private:
    QToolButton* heading_;
    QHBoxLayout* top_;
    QWidget* content_;
    QVBoxLayout* rows_;
};

} // namespace lumorph::studio
