#pragma once

#include <vector>

#include <QButtonGroup>
#include <QString>
#include <QWidget>

namespace lumorph::studio {

/// Buttons side by side of which one is down.
class Segments : public QWidget {
    Q_OBJECT
public:
    struct Segment {
        QString name; ///< objectName
        QString text;
        QString hint;
    };
    Segments(const std::vector<Segment>& segments, QWidget* parent = nullptr);

    void setChosen(int index);
    /// What a segment says, and whether it is there at all.
    void setSegment(int index, const QString& text, const QString& hint, bool isOffered = true);

signals:
    void chosen(int index); ///< by the user

private:
    QButtonGroup group_;
};

} // namespace lumorph::studio
