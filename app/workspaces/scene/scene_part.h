#pragma once

#include <cmath>
#include <functional>
#include <type_traits>

#include "app/studio/document/scene_edit.h"
#include "core/base/units.h"

namespace lumorph::studio {

/// A part of scene or installation that a form shows and edits, such as the material of the chosen item. Both find
/// nothing (null) while there is no such part.
template <class Object> struct Part {
    std::function<const Object*(const StudioState&)> read;
    std::function<Object*(StudioState&)> write;
};

/// A part of the scene, from one generic lambda that gives a pointer into the scene it is given.
template <class Object, class Find> [[nodiscard]] Part<Object> makePart(Find find) {
    return {[find](const StudioState& state) -> const Object* { return find(*state.scene); },
            [find](StudioState& state) -> Object* { return find(sceneToEdit(state)); }};
}
/// The same of what stands in the room.
template <class Object, class Find> [[nodiscard]] Part<Object> makeInstallationPart(Find find) {
    return {[find](const StudioState& state) -> const Object* { return find(*state.installation); },
            [find](StudioState& state) -> Object* { return find(installationToEdit(state)); }};
}

/// A part of a part, from one generic lambda that gives a pointer into what it is given.
template <class Inner, class Outer, class Step> [[nodiscard]] Part<Inner> within(const Part<Outer>& outer, Step step) {
    return {[outer, step](const StudioState& state) -> const Inner* {
                const Outer* found = outer.read(state);
                return found ? step(*found) : nullptr;
            },
            [outer, step](StudioState& state) -> Inner* {
                Outer* found = outer.write(state);
                return found ? step(*found) : nullptr;
            }};
}

/// The same where it is always there: `step` gives a reference.
template <class Inner, class Outer, class Step>
[[nodiscard]] Part<Inner> memberOf(const Part<Outer>& outer, Step step) {
    return within<Inner>(outer, [step](auto& found) { return &step(found); });
}

template <class Number> [[nodiscard]] double asNumber(const Number& number) {
    if constexpr (std::is_same_v<Number, Angle>)
        return number.inRadians();
    else
        return static_cast<double>(number);
}

template <class Number> void setNumber(Number& number, double value) {
    if constexpr (std::is_same_v<Number, Angle>)
        number = Angle::radians(value);
    else if constexpr (std::is_integral_v<Number>)
        number = static_cast<Number>(std::lround(value));
    else
        number = static_cast<Number>(value);
}

} // namespace lumorph::studio
