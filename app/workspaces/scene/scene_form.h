#pragma once

#include <optional>
#include <vector>

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QVBoxLayout>
#include <QWidget>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/studio/document/scene_edit.h"
#include "app/studio/widgets/quantity.h"
#include "app/studio/widgets/segments.h"
#include "app/workspaces/scene/collapsible_section.h"
#include "app/workspaces/scene/scene_part.h"

namespace lumorph::studio {

using StateEdit = std::function<void(StudioState&)>;

/// What a row of a form is called. `name` becomes the control's objectName.
struct FormWords {
    QString name;
    QString label; ///< what the user reads; an edit is called "Change LABEL"
    QString hint;
};

/// Which numbers a row takes, SI. A step of 0 is the quantity's usual one.
struct FormRange {
    Quantity quantity = Quantity::plain;
    double low = 0.0, high = 1.0;
    double reset = 0.0;
    double step = 0.0;
};

/// Rows that show and edit parts of the document's scene and installation: each edit is a step of undo, each drag is
/// one. What a row shows comes from the document alone, by `refresh`.
class SceneForm : public QWidget {
    Q_OBJECT
public:
    explicit SceneForm(StudioDocument& document, QWidget* parent = nullptr);

    /// A group of rows; those that are added later go into it. Another section, or `endSection`, ends it.
    CollapsibleSection& section(const QString& name, const QString& title, bool open = true);
    void endSection();
    void add(QWidget* widget);
    /// A plain sentence, muted.
    QLabel* sentence(const QString& name, const QString& text = {});
    /// Shows a widget only while this holds.
    void showWhile(QWidget* widget, std::function<bool(const StudioState&)> holds);
    /// Runs with each refresh.
    void onRefresh(std::function<void(const StudioState&)> run);
    void refresh();

    template <class Object, class Ref>
    QWidget* number(const FormWords& words, const FormRange& range, const Part<Object>& part, Ref ref) {
        return addNumbers(words.label, {numberRow(words, range, part, ref)});
    }
    /// Two or three numbers side by side, as of a vector; `ends` are the last letters of their names and labels.
    template <class Object, class Ref>
    QWidget* vector(const FormWords& words, const FormRange& range, const QString& ends, const Part<Object>& part,
                    Ref ref) {
        std::vector<NumberRow> rows;
        for (int axis = 0; axis < ends.size(); ++axis) {
            FormWords one = words;
            one.name += QStringLiteral(".") + ends[axis];
            one.label += QStringLiteral(" ") + ends[axis];
            rows.push_back(numberRow(
                one, range, part, [ ref, axis ](auto& object) -> auto& { return ref(object)[axis]; }));
        }
        return addNumbers(words.label, rows);
    }
    template <class Object, class Ref> QCheckBox* check(const FormWords& words, const Part<Object>& part, Ref ref) {
        return addCheck(
            words,
            [part, ref](const StudioState& state) -> std::optional<bool> {
                const Object* object = part.read(state);
                return object ? std::optional(ref(*object)) : std::nullopt;
            },
            [part, ref](StudioState& state, bool on) {
                if (Object* object = part.write(state)) ref(*object) = on;
            });
    }
    template <class Object, class Ref> QWidget* color(const FormWords& words, const Part<Object>& part, Ref ref) {
        return addColor(
            words,
            [part, ref](const StudioState& state) -> std::optional<glm::vec3> {
                const Object* object = part.read(state);
                return object ? std::optional<glm::vec3>(ref(*object)) : std::nullopt;
            },
            [part, ref](StudioState& state, const glm::vec3& value) {
                if (Object* object = part.write(state)) ref(*object) = value;
            });
    }
    /// Buttons of which one is down, or a list of names to choose from, for an enumeration or a whole number.
    template <class Object, class Ref>
    Segments* segments(const FormWords& words, const std::vector<Segments::Segment>& choices, const Part<Object>& part,
                       Ref ref) {
        return addSegments(words, choices, readIndex(part, ref), writeIndex(part, ref));
    }
    template <class Object, class Ref>
    QComboBox* choice(const FormWords& words, const QStringList& names, const Part<Object>& part, Ref ref) {
        return addChoice(words, names, readIndex(part, ref), writeIndex(part, ref));
    }

    using ReadNumber = std::function<std::optional<double>(const StudioState&)>;
    using WriteNumber = std::function<void(StudioState&, double)>;
    struct NumberRow {
        FormWords words;
        FormRange range;
        ReadNumber read;
        WriteNumber write;
    };
    /// Numbers side by side; one alone stands beside its label.
    QWidget* addNumbers(const QString& label, const std::vector<NumberRow>& rows);
    using ReadBool = std::function<std::optional<bool>(const StudioState&)>;
    QCheckBox* addCheck(const FormWords& words, ReadBool read, std::function<void(StudioState&, bool)> write);
    using ReadColor = std::function<std::optional<glm::vec3>(const StudioState&)>;
    QWidget* addColor(const FormWords& words, ReadColor read,
                      std::function<void(StudioState&, const glm::vec3&)> write);
    using ReadIndex = std::function<std::optional<int>(const StudioState&)>;
    using WriteIndex = std::function<void(StudioState&, int)>;
    Segments* addSegments(const FormWords& words, const std::vector<Segments::Segment>& choices, ReadIndex read,
                          const WriteIndex& write);
    QComboBox* addChoice(const FormWords& words, const QStringList& names, ReadIndex read, const WriteIndex& write);

    [[nodiscard]] StudioDocument& document() noexcept { return document_; }
    [[nodiscard]] const StudioState& state() const { return document_.state(); }
    /// One step of undo, or what is seen of it while something is dragged.
    void edit(const QString& what, const StateEdit& edit);

private:
    template <class Object, class Ref>
    static NumberRow numberRow(const FormWords& words, const FormRange& range, const Part<Object>& part, Ref ref) {
        return {words, range,
                [part, ref](const StudioState& state) -> std::optional<double> {
                    const Object* object = part.read(state);
                    return object ? std::optional(asNumber(ref(*object))) : std::nullopt;
                },
                [part, ref](StudioState& state, double value) {
                    if (Object* object = part.write(state)) setNumber(ref(*object), value);
                }};
    }
    template <class Object, class Ref> static ReadIndex readIndex(const Part<Object>& part, Ref ref) {
        return [part, ref](const StudioState& state) -> std::optional<int> {
            const Object* object = part.read(state);
            return object ? std::optional(static_cast<int>(ref(*object))) : std::nullopt;
        };
    }
    template <class Object, class Ref> static WriteIndex writeIndex(const Part<Object>& part, Ref ref) {
        return [part, ref](StudioState& state, int index) {
            if (Object* object = part.write(state))
                ref(*object) = static_cast<std::decay_t<decltype(ref(*object))>>(index);
        };
    }
    QWidget* makeNumber(const NumberRow& row);

    StudioDocument& document_;
    QVBoxLayout* column_;
    QVBoxLayout* rows_; ///< where the next row goes
    std::vector<std::function<void(const StudioState&)>> refreshes_;
};

/// Colours of the scene (sRGB in [0, 1]) as those of the window.
[[nodiscard]] QColor toColor(const glm::vec3& color);
[[nodiscard]] glm::vec3 fromColor(const QColor& color);

} // namespace lumorph::studio
