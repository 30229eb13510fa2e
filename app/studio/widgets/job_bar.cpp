#include <QLabel>
#include <QMap>
#include <QProgressBar>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>

#include "app/studio/look/icons.h"
#include "app/studio/widgets/panel.h"

namespace lumorph::studio {
namespace {

constexpr int kPatienceMilliseconds = 200; ///< a shorter job would only flicker

struct JobRow {
    QWidget* widget = nullptr;
    QLabel* text = nullptr;
    QProgressBar* bar = nullptr;
};

QProgressBar* makeBar(QWidget* parent) {
    auto* bar = new QProgressBar(parent);
    bar->setRange(0, 1000);
    bar->setTextVisible(false);
    return bar;
}

void showFraction(QProgressBar& bar, double fraction) {
    bar.setRange(0, fraction < 0.0 ? 0 : 1000); // without a range it says that something goes on
    bar.setValue(static_cast<int>(fraction * 1000));
}

QToolButton* makeCancel(QWidget* parent) {
    auto* cancel = new QToolButton(parent);
    cancel->setObjectName("job.cancel");
    cancel->setIcon(icon("cancel", IconRole::muted));
    cancel->setToolTip("Cancel");
    cancel->setAccessibleName("Cancel");
    return cancel;
}

JobRow makeJobRow(Jobs& jobs, Jobs::Id id, QWidget* parent) {
    JobRow row;
    row.widget = new QWidget(parent);
    row.widget->setObjectName("job");
    auto* layout = new QHBoxLayout(row.widget);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    auto* column = new QVBoxLayout;
    column->setSpacing(6);
    row.text = new QLabel(row.widget);
    row.text->setTextFormat(Qt::PlainText);
    row.text->setProperty("look", "muted");
    row.text->setMinimumWidth(1); // a long stage must not widen the dock
    row.bar = makeBar(row.widget);
    column->addWidget(row.text);
    column->addWidget(row.bar);
    layout->addLayout(column, 1);
    QToolButton* cancel = makeCancel(row.widget);
    QObject::connect(cancel, &QToolButton::clicked, &jobs, [&jobs, id] { jobs.cancel(id); });
    layout->addWidget(cancel);
    return row;
}

class JobBar : public QWidget {
public:
    JobBar(Jobs& jobs, QString place, QWidget* parent) : QWidget(parent), jobs_(jobs), place_(std::move(place)) {
        setObjectName("jobs." + place_);
        layout_ = new QVBoxLayout(this);
        layout_->setContentsMargins(0, 0, 0, 0);
        layout_->setSpacing(8);
        hide();
        connect(&jobs, &Jobs::started, this, [this](int id) { wait(id); });
        connect(&jobs, &Jobs::progressed, this, [this] { refresh(); });
        connect(&jobs, &Jobs::finished, this, [this](int id) { remove(id); });
        for (const auto& status : jobs.running()) wait(status.id);
    }

private:
    void wait(int id) {
        QTimer::singleShot(kPatienceMilliseconds, this, [this, id] {
            for (const auto& status : jobs_.running())
                if (status.id == id && status.place == place_) show(status);
        });
    }

    void show(const Jobs::Status& status) {
        if (rows_.contains(status.id)) return;
        const JobRow row = makeJobRow(jobs_, status.id, this);
        rows_.insert(status.id, row);
        layout_->addWidget(row.widget);
        setVisible(true);
        refresh();
    }

    void remove(int id) {
        if (!rows_.contains(id)) return;
        QWidget* row = rows_.take(id).widget;
        row->hide();
        row->deleteLater();
        setVisible(!rows_.isEmpty());
    }

    void refresh() {
        if (rows_.isEmpty()) return;
        for (const auto& status : jobs_.running()) {
            const auto row = rows_.constFind(status.id);
            if (row == rows_.constEnd()) continue;
            row->text->setText(status.stage.isEmpty() ? status.title : status.title + ": " + status.stage);
            row->text->setToolTip(row->text->text());
            showFraction(*row->bar, status.fraction);
        }
    }

    Jobs& jobs_;
    QString place_;
    QVBoxLayout* layout_ = nullptr;
    QMap<int, JobRow> rows_;
};

/// The newest job with a short bar, in the height of a line.
class JobLine : public QWidget {
public:
    JobLine(Jobs& jobs, QWidget* parent) : QWidget(parent), jobs_(jobs) {
        setObjectName("status.jobs");
        auto* row = new QHBoxLayout(this);
        row->setContentsMargins(0, 0, 0, 0);
        row->setSpacing(8);
        text_ = new QLabel(this);
        text_->setTextFormat(Qt::PlainText);
        bar_ = makeBar(this);
        bar_->setMaximumWidth(120);
        text_->setMinimumWidth(1); // the other three things of the line come first
        QToolButton* cancel = makeCancel(this);
        cancel->setProperty("look", "title");
        row->addWidget(text_);
        row->addWidget(bar_);
        row->addWidget(cancel);
        hide();
        connect(cancel, &QToolButton::clicked, this, [this] { jobs_.cancel(shown_); });
        connect(&jobs, &Jobs::started, this,
                [this] { QTimer::singleShot(kPatienceMilliseconds, this, [this] { refresh(); }); });
        connect(&jobs, &Jobs::progressed, this, [this] {
            if (isVisible()) refresh();
        });
        connect(&jobs, &Jobs::finished, this, [this] { refresh(); });
    }

private:
    void refresh() {
        const auto running = jobs_.running();
        setVisible(!running.empty());
        if (running.empty()) return;
        const Jobs::Status& newest = running.back();
        shown_ = newest.id;
        text_->setText(newest.title);
        text_->setToolTip(newest.stage);
        showFraction(*bar_, newest.fraction);
    }

    Jobs& jobs_;
    int shown_ = 0;
    QLabel* text_ = nullptr;
    QProgressBar* bar_ = nullptr;
};

} // namespace

QWidget* makeJobLine(Jobs& jobs, QWidget* parent) { return new JobLine(jobs, parent); }

QWidget* makeJobBar(Jobs& jobs, const QString& place, QWidget* parent) { return new JobBar(jobs, place, parent); }

} // namespace lumorph::studio
