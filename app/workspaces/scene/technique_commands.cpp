#include "app/workspaces/scene/technique_commands.h"

#include <optional>
#include <utility>

#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "app/applications/registry/demos.h"
#include "app/studio/document/scene_edit.h"
#include "app/studio/look/icons.h"
#include "app/studio/widgets/segments.h"
#include "core/base/error.h"

namespace lumorph::studio {

namespace {

/// The demonstration with a scene for each number key.
const Demo& demoOfSteps() {
    for (const Demo& demo : demos())
        if (!demo.steps().empty()) return demo;
    throw InvalidInput("demos", "none has steps", "give one some");
}

/// Whether a scene holds the things of that demonstration.
bool isTechniqueScene(const Scene& scene, const Scene& plain) {
    if (scene.items.size() != plain.items.size()) return false;
    for (std::size_t i = 0; i < scene.items.size(); ++i)
        if (scene.items[i].id != plain.items[i].id || scene.items[i].kind.index() != plain.items[i].kind.index() ||
            scene.items[i].name != plain.items[i].name)
            return false;
    return true;
}

QString titleOf(const DemoStep& technique) {
    return QObject::tr("Technique: %1").arg(QString::fromStdString(technique.name.english).toLower());
}

class TechniqueCommands : public QObject {
public:
    explicit TechniqueCommands(Studio& studio)
        : QObject(&studio.commands), studio_(studio), steps_(demoOfSteps().steps()) {
        for (const DemoStep& technique : steps_) add(technique);
        addOff();
        connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
            if (parts & StatePart::scene) follow();
        });
        follow();
    }

private:
    void add(const DemoStep& technique) {
        Commands::Options options;
        options.icon = "light";
        options.workspace = "scene";
        const QString id = QString("technique.%1").arg(technique.key);
        QAction* action = studio_.commands.add(id, titleOf(technique), options, [this, technique] { show(technique); });
        action->setToolTip(QString::fromStdString(technique.sentence.english));
        actions_.emplace_back(technique.key, action);
    }

    void show(const DemoStep& technique) {
        if (!open_) { // its demo first
            wanted_ = technique;
            studio_.project.openDemo(demoOfSteps().name);
            return;
        }
        studio_.project.endProgram(); // the host takes over from visitors
        editScene(studio_.document, titleOf(technique), [&](Scene& scene) { scene = technique.scene; });
    }

    void addOff() {
        Commands::Options options;
        options.icon = "compare";
        options.workspace = "scene";
        off_ = studio_.commands.add("technique.off", QObject::tr("Technique: with and without"), options,
                                    [this] { exchange(); });
        off_->setToolTip(QObject::tr("The same scene without what the technique adds, and with it again"));
    }

    /// Of a scene that the host has changed there is no other.
    void exchange() {
        const Scene& now = *studio_.document.state().scene;
        for (const DemoStep& step : steps_) {
            if (!(now == step.scene) && !(now == step.without)) continue;
            const Scene& other = now == step.scene ? step.without : step.scene;
            return editScene(studio_.document, off_->text(), [&](Scene& scene) { scene = other; });
        }
    }

    /// The number keys belong to the demo: elsewhere a stray key must not change a scene.
    void follow() {
        const bool open = isTechniqueScene(*studio_.document.state().scene, steps_.front().scene);
        if (open == open_) return;
        open_ = open;
        for (const auto& [key, action] : actions_)
            action->setShortcut(open ? QKeySequence(Qt::Key_0 + key) : QKeySequence());
        off_->setShortcut(open ? QKeySequence(Qt::Key_O) : QKeySequence());
        if (open && wanted_)
            QTimer::singleShot(0, this, [this, technique = *std::exchange(wanted_, std::nullopt)] { show(technique); });
    }

    Studio& studio_;
    const std::vector<DemoStep> steps_;
    QAction* off_ = nullptr;
    bool open_ = false;
    std::optional<DemoStep> wanted_; ///< as soon as the demo is there
    std::vector<std::pair<int, QAction*>> actions_;
};

class TechniqueBar : public QWidget {
public:
    TechniqueBar(Studio& studio, QWidget* parent) : QWidget(parent), studio_(studio), sentence_(new QLabel(this)) {
        setObjectName("scene.techniques");
        std::vector<Segments::Segment> segments;
        for (const DemoStep& technique : all_) {
            segments.push_back({QString("technique.%1.button").arg(technique.key), QString::number(technique.key),
                                studio.settings.say(technique.name)});
        }
        numbers_ = new Segments(segments, this);
        numbers_->setAccessibleName(tr("Techniques"));
        sentence_->setObjectName("technique.sentence");
        sentence_->setWordWrap(true);
        off_ = new QPushButton(icon("compare"), tr("Without it"), this);
        off_->setObjectName("technique.off.button");
        off_->setCheckable(true);
        off_->setToolTip(tr("The same scene without what the technique adds, to compare (O)"));
        connect(off_, &QPushButton::clicked, this, [this] {
            if (QAction* action = studio_.commands.find("technique.off")) action->trigger();
            refresh();
        });
        connect(&studio.settings, &Settings::languageChanged, this, &TechniqueBar::refresh);
        auto* column = new QVBoxLayout(this);
        column->setContentsMargins(0, 0, 0, 0);
        column->setSpacing(4);
        column->addWidget(numbers_);
        column->addWidget(off_, 0, Qt::AlignLeft);
        column->addWidget(sentence_);
        connect(numbers_, &Segments::chosen, this, [this](int index) {
            if (QAction* action =
                    studio_.commands.find(QString("technique.%1").arg(all_.at(static_cast<std::size_t>(index)).key)))
                action->trigger();
        });
        connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
            if (parts & StatePart::scene) refresh();
        });
        refresh();
    }

private:
    void refresh() {
        const Scene& scene = *studio_.document.state().scene;
        const bool open = isTechniqueScene(scene, all_.front().scene);
        setVisible(open);
        if (!open) return;
        for (std::size_t i = 0; i < all_.size(); ++i) {
            const bool on = all_[i].scene == scene;
            if (!on && !(all_[i].without == scene)) continue;
            numbers_->setChosen(static_cast<int>(i));
            off_->setChecked(!on);
            sentence_->setText(QString("<b>%1</b><br>%2")
                                   .arg(studio_.settings.say(all_[i].name).toHtmlEscaped(),
                                        studio_.settings.say(all_[i].sentence).toHtmlEscaped()));
            return;
        }
    }

    Studio& studio_;
    const std::vector<DemoStep> all_ = demoOfSteps().steps();
    Segments* numbers_ = nullptr;
    QPushButton* off_ = nullptr;
    QLabel* sentence_;
};

} // namespace

void addTechniqueCommands(Studio& studio) { new TechniqueCommands(studio); }

QWidget* makeTechniqueBar(Studio& studio, QWidget* parent) { return new TechniqueBar(studio, parent); }

} // namespace lumorph::studio
