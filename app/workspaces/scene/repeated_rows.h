#pragma once

#include <memory>

#include <QPushButton>
#include <QToolButton>

#include "app/studio/look/icons.h"
#include "app/workspaces/scene/scene_form.h"

namespace lumorph::studio {

/// What a list of equal parts is called: "Wave", "Add a wave".
struct RepeatedWords {
    QString name; ///< the controls are called `name.0.what`, the buttons `name.0.remove` and `name.add`
    QString one;
    QString add;
};

/// The rows of each element of a list, with buttons that add and remove one. Rows are made when they are first needed
/// and stay, hidden where the list has become shorter.
template <class Element>
void addRepeatedRows(SceneForm& form, const RepeatedWords& words, const Part<std::vector<Element>>& list,
                     const std::function<void(SceneForm&, const Part<Element>&, const QString&)>& addRows) {
    auto* held = new QWidget(&form);
    auto* column = new QVBoxLayout(held);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(6);
    form.add(held);
    const auto rows = std::make_shared<std::vector<SceneForm*>>();
    const auto makeOne = [&form, held, column, rows, words, list, addRows] {
        const std::size_t index = rows->size();
        const QString name = words.name + '.' + QString::number(index);
        const auto part = within<Element>(
            list, [index](auto& all) -> decltype(all.data()) { return index < all.size() ? &all[index] : nullptr; });
        auto* one = new SceneForm(form.document(), held);
        CollapsibleSection& section = one->section(name, words.one + ' ' + QString::number(index + 1));
        auto* remove = new QToolButton;
        remove->setObjectName(name + ".remove");
        remove->setIcon(icon("close", IconRole::muted));
        remove->setToolTip(QObject::tr("Remove %1 %2").arg(words.one.toLower()).arg(index + 1));
        remove->setAccessibleName(remove->toolTip());
        remove->setFocusPolicy(Qt::StrongFocus);
        section.addToHeading(remove);
        QObject::connect(remove, &QToolButton::clicked, &form, [&form, list, index, words] {
            form.edit(QObject::tr("Remove %1").arg(words.one.toLower()), [&](StudioState& state) {
                auto* all = list.write(state);
                if (all && index < all->size()) all->erase(all->begin() + static_cast<std::ptrdiff_t>(index));
            });
        });
        addRows(*one, part, name);
        column->addWidget(one);
        rows->push_back(one);
    };
    form.onRefresh([list, rows, makeOne](const StudioState& state) {
        const auto* all = list.read(state);
        const std::size_t count = all ? all->size() : 0;
        while (rows->size() < count) makeOne();
        for (std::size_t i = 0; i < rows->size(); ++i) {
            (*rows)[i]->setVisible(i < count);
            if (i < count) (*rows)[i]->refresh();
        }
    });
    auto* add = new QPushButton(words.add, &form);
    add->setObjectName(words.name + ".add");
    add->setIcon(icon("plus"));
    QObject::connect(add, &QPushButton::clicked, &form, [&form, list, words] {
        form.edit(words.add, [&](StudioState& state) {
            if (auto* all = list.write(state)) all->push_back(all->empty() ? Element{} : all->back());
        });
    });
    form.add(add);
}

} // namespace lumorph::studio
